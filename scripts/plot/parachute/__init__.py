"""Figures of drogue-parachute."""
