"""Figures, benchmark goals and published results for drogue-options."""
