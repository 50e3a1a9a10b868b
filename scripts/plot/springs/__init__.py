"""Figures and benchmark goals of drogue-springs."""
