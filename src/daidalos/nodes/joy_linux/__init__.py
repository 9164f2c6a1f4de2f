"""The joystick node for Linux, as ROS 2 offers it."""
