"""The action that logs a message, under the module name that ROS 2 had first."""

from .log import LogInfo as LogInfo
