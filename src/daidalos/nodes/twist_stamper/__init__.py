"""Stamps on velocities, as ROS 2 offers them."""
