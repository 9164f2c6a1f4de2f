"""Module of the command `ros2 control` under ROS 2's name: `control`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
