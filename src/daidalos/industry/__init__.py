"""Welding, servoing, grinding, RAPID, calibration and lighting."""
