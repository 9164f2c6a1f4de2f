"""Parameters of MoveIt out of a robot's configuration package, for launch files."""

from moveit_configs_utils.moveit_configs_builder import MoveItConfigs as MoveItConfigs
from moveit_configs_utils.moveit_configs_builder import MoveItConfigsBuilder as MoveItConfigsBuilder
