"""Module of the command `ros2 run` under ROS 2's name: `run`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
