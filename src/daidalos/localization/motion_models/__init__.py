"""Motion models of odometry."""
