"""ROS 2 over zenoh, in rmw_zenoh's wire format."""
