"""Substitutions for robot descriptions."""

from moveit_configs_utils.substitutions.xacro import Xacro as Xacro
