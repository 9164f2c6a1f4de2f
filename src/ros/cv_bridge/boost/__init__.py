"""Where ROS 2's own package keeps its compiled part."""
