"""AMCL under its ROS 1 name."""
