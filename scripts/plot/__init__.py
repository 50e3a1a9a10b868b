"""Pictures of a Drogue run directory and the page of the demo."""
