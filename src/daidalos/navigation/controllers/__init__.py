"""Velocities that make a robot follow a path and keep off what the local costmap shows."""
