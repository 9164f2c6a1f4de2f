"""Substitutions that rewrite parameter files on their way to nodes."""

from .has_node_params import HasNodeParams as HasNodeParams
from .launch_config_as_bool import LaunchConfigAsBool as LaunchConfigAsBool
from .parse_multirobot_pose import ParseMultiRobotPose as ParseMultiRobotPose
from .replace_string import ReplaceString as ReplaceString
from .rewritten_yaml import RewrittenYaml as RewrittenYaml
