"""The services by which others get and set the levels of loggers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import rclpy.logging
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.qos import qos_profile_services_default

if TYPE_CHECKING:
    from rclpy.node import Node

TOPIC_SEPARATOR_STRING = "/"


class LoggingService:
    """Services ``get_logger_levels`` and ``set_logger_levels`` of a node."""

    def __init__(self, node: Node) -> None:
        from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels

        node.create_service(
            GetLoggerLevels,
            "~/get_logger_levels",
            self._get_logger_levels,
            qos_profile=qos_profile_services_default,
        )
        node.create_service(
            SetLoggerLevels,
            "~/set_logger_levels",
            self._set_logger_levels,
            qos_profile=qos_profile_services_default,
        )

    def _get_logger_levels(self, request: Any, response: Any) -> Any:
        from rcl_interfaces.msg import LoggerLevel

        for name in request.names:
            level = rclpy.logging.get_logger_level(name)
            response.levels.append(LoggerLevel(name=name, level=int(level)))
        return response

    def _set_logger_levels(self, request: Any, response: Any) -> Any:
        from rcl_interfaces.msg import SetLoggerLevelsResult

        for level in request.levels:
            result = SetLoggerLevelsResult(successful=True)
            try:
                rclpy.logging.set_logger_level(level.name, LoggingSeverity(level.level))
            except ValueError:
                result.successful = False
                result.reason = "Failed reason: Invalid logger level."
            response.results.append(result)
        return response
