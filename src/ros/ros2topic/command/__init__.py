"""Module of the command `ros2 topic` under ROS 2's name: `topic`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
