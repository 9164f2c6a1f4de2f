"""Module of the command `ros2 component` under ROS 2's name: `component`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
