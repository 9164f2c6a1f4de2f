"""The simulator as Gazebo's ROS packages offer it."""

EXECUTABLES = {"gzserver": "gzserver", "spawn_entity.py": "spawn_entity", "spawn_model": "spawn_model"}
