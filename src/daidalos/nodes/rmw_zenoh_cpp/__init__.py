"""Router of ROS 2's zenoh middleware."""
