"""Module of the command `ros2 service` under ROS 2's name: `service`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
