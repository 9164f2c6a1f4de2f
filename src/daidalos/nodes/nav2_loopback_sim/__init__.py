"""Simulator without physics: the robot does what it is told, and sees the map."""
