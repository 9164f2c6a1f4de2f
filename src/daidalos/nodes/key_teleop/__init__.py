"""Teleoperation of a robot with the arrow keys."""
