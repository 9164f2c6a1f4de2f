"""Driving a robot with the arrow keys."""
