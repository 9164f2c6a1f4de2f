"""Module of the command `ros2 interface` under ROS 2's name: `interface`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
