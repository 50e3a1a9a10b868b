"""Figures of run directories, pages of benchmark records, and the page of the demo."""
