"""States that use topics, services and actions, and state machines as action servers."""

import rclpy
import smach
from rclpy.logging import get_logger

from smach_ros.action_server_wrapper import ActionServerWrapper
from smach_ros.condition_state import ConditionState
from smach_ros.introspection import IntrospectionClient, IntrospectionServer
from smach_ros.monitor_state import MonitorState
from smach_ros.node import SmachNode
from smach_ros.ros_state import RosState
from smach_ros.service_state import ServiceState
from smach_ros.simple_action_state import SimpleActionState
from smach_ros.util import set_preempt_handler

__all__ = [
    "ActionServerWrapper",
    "ConditionState",
    "IntrospectionClient",
    "IntrospectionServer",
    "MonitorState",
    "RosState",
    "ServiceState",
    "SimpleActionState",
    "SmachNode",
    "set_preempt_handler",
]

_logger = get_logger(__name__)
smach.set_loggers(
    lambda message: _logger.info(message),
    lambda message: _logger.warning(message),
    lambda message: _logger.debug(message),
    lambda message: _logger.error(message),
)
smach.set_shutdown_check(lambda: not rclpy.ok())
