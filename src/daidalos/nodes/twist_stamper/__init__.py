"""Conversion of velocities to and from stamped ones, with ROS 2's interface."""
