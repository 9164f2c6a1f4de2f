"""Turtles that draw, from the first ROS 2 tutorials."""
