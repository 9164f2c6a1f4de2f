"""Point clouds as flat scans, and scans as clouds, as ROS 2 offers them."""
