"""Hardware of ABB controllers for ros2_control."""
