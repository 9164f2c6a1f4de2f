"""Maps from the scans of a lidar alone, with the names of ROS 1's hector_slam."""
