"""Teleoperation with a game pad, with ROS 2's interface."""
