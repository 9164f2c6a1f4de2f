"""Multiplexer of velocities, with ROS 2's interface."""
