"""Nodes of the ROS executables, one file each, grouped by ROS package."""
