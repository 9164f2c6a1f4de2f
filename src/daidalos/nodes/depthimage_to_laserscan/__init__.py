"""Depth images as flat scans, as ROS 2 offers them."""
