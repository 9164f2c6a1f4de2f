"""One file per ROS executable, grouped by ROS package: thin shells around the libraries."""
