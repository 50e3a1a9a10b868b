"""Pages of benchmark records: reading, evaluation and rendering."""
