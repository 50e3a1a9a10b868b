"""Figures of drogue-parachute: canopies in their flow, and forces on canopies and bodies."""
