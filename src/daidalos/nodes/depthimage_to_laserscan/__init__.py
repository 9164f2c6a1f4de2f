"""Conversion of depth images to laser scans, with ROS 2's interface."""
