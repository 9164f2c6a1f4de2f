"""Depth images of ROS."""

METRES = {"16UC1": 0.001, "mono16": 0.001, "32FC1": 1.0}
"""Metres in a unit of a depth image, by its encoding."""
