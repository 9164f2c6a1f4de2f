"""Module of the command `ros2 doctor` under ROS 2's name: `doctor`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
