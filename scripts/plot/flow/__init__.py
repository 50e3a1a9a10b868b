"""Figures, benchmark goals, and evidence tables of flow."""
