"""Module of the command `ros2 bag` under ROS 2's name: `bag`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
