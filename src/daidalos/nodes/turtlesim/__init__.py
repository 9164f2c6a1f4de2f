"""Turtles that draw: the first robots of a ROS 2 course."""
