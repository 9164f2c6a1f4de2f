"""Module of the command `ros2 action` under ROS 2's name: `action`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
