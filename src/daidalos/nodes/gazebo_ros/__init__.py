"""Simulator with the interface of Gazebo's ROS packages."""

EXECUTABLES = {"gzserver": "gzserver", "spawn_entity.py": "spawn_entity", "spawn_model": "spawn_model"}
