"""Joystick node for Linux with ROS 2's interface."""
