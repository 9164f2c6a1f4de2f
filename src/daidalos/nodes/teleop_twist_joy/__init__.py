"""Driving with a game pad, as ROS 2 offers it."""
