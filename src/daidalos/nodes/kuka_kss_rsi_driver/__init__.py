"""Hardware of KUKA controllers for ros2_control."""
