"""Module of the command `ros2 param` under ROS 2's name: `param`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
