"""Location of the compiled part in ROS 2's own package."""
