"""Log messages of a node on ``/rosout``."""

from __future__ import annotations

import weakref
from typing import Any

from rclpy.impl.entities import NodeHandle, PublisherHandle
from rclpy.impl.log_output import OUTPUT, Record
from rclpy.qos import QoSProfile


class RosoutPublisher:
    """Publisher of what is logged under a node's name, or under a name below it."""

    def __init__(self, handle: NodeHandle, qos: QoSProfile) -> None:
        from rcl_interfaces.msg import Log

        self._publisher = PublisherHandle(handle, Log, "/rosout", qos)
        self._name = handle.logger_name()
        self._handler = weakref.WeakMethod(self._publish)
        OUTPUT.handlers[self._name] = self._handler

    def _publish(self, record: Record) -> None:
        from builtin_interfaces.msg import Time
        from rcl_interfaces.msg import Log

        seconds, nanoseconds = divmod(record.stamp_ns, 1_000_000_000)
        message = Log(
            stamp=Time(sec=seconds, nanosec=nanoseconds),
            level=int(record.severity),
            name=record.name,
            msg=record.message,
            file=record.file,
            function=record.function,
            line=record.line,
        )
        self._publisher.impl.publish(message)

    def destroy(self) -> None:
        """Publish no more."""
        if OUTPUT.handlers.get(self._name) is self._handler:
            del OUTPUT.handlers[self._name]
        self._publisher.destroy_when_not_in_use()


def rosout(handle: NodeHandle, setting: bool | QoSProfile, default: QoSProfile) -> Any:
    """Return the node's rosout publisher, or None when it is not wanted."""
    if not setting or not handle.rosout_enabled:
        return None
    return RosoutPublisher(handle, setting if isinstance(setting, QoSProfile) else default)
