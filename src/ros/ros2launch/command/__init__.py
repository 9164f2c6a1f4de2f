"""Module of the command `ros2 launch` under ROS 2's name: `launch`."""

from ros2cli import built_in_verbs

built_in_verbs.register()
