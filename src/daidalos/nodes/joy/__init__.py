"""Joystick node with ROS 2's interface."""
