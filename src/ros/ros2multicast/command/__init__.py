"""Module of the command `ros2 multicast` under ROS 2's name: `multicast`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
