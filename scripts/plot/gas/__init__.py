"""Figures, exact solutions and benchmark goals of drogue-gas."""
