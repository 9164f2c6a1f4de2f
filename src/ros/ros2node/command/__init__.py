"""Module of the command `ros2 node` under ROS 2's name: `node`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
