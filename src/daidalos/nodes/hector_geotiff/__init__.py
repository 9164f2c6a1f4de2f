"""Pictures of maps with the way of the robot, with the names of ROS 1's hector_slam."""
