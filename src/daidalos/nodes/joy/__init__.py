"""The joystick node, as ROS 2 offers it."""
