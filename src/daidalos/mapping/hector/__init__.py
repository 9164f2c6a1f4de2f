"""Mapping with a lidar alone, without odometry: scans matched against a pyramid of log-odds grids."""
