"""Choosing among velocities, as ROS 2 offers it."""
