"""SLAM."""
