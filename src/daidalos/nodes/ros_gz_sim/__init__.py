"""The simulator as ros_gz_sim offers it."""
