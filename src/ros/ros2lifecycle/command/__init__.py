"""Module of the command `ros2 lifecycle` under ROS 2's name: `lifecycle`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
