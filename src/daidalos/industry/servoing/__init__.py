"""Servoing of a tool along a seam that a laser profile sensor measures ahead of it."""
