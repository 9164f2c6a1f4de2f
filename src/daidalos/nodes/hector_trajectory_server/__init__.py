"""Way of a frame as a path, with the names of ROS 1's hector_slam."""
