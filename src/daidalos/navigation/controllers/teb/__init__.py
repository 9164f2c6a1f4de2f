"""Timed elastic bands: poses with the times between them, optimised by sparse least squares."""
