"""Module of the command `ros2 pkg` under ROS 2's name: `pkg`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
