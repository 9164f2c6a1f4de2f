"""Conversion of point clouds to laser scans and back, with ROS 2's interface."""
