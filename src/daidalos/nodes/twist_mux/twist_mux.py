"""`twist_mux`: forwards the velocities of the active source with the highest priority."""

from __future__ import annotations

from functools import partial
from typing import Any, TypeVar

from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import DiagnosticStatusWrapper, Updater
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import Bool

from daidalos.nodes.twist_mux._priorities import Lock, Source, active, lock_priority

S = TypeVar("S", bound=Source)


class TwistMux(Node):
    """Node that publishes ``cmd_vel_out``.

    Parameters of the node: for each source NAME ``topics.NAME.topic``, ``topics.NAME.timeout`` (for how long its last
    velocity counts [s]) and ``topics.NAME.priority`` (from 0 to 255); the same below ``locks`` for topics of
    std_msgs/Bool that lock all sources up to their priority, when they say so or are silent; ``use_stamped`` (whether
    the velocities are TwistStamped).
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("twist_mux", automatically_declare_parameters_from_overrides=True, **kwargs)
        if not self.has_parameter("use_stamped"):
            self.declare_parameter("use_stamped", False)
        kind = TwistStamped if self.get_parameter("use_stamped").value else Twist
        self._sources = self._read("topics", Source)
        self._locks = self._read("locks", Lock)
        if not self._sources:
            raise RuntimeError("twist_mux needs sources: parameters such as 'topics.navigation.topic'")
        self._commands: Publisher = self.create_publisher(kind, "cmd_vel_out", 10)
        for source in self._sources:
            self.create_subscription(kind, source.topic, partial(self._forward_message, source), 10)
        for lock in self._locks:
            self.create_subscription(Bool, lock.topic, partial(self._set_lock, lock), 10)
        self._diagnostics = Updater(self)
        self._diagnostics.setHardwareID("none")
        self._diagnostics.add("Twist mux status", self._notify)

    def _read(self, group: str, kind: type[S]) -> list[S]:
        given = {name: parameter.value for name, parameter in self.get_parameters_by_prefix(group).items()}
        names = dict.fromkeys(name.rpartition(".")[0] for name in given)
        return [self._read_one(group, name, given, kind) for name in names]

    def _read_one(self, group: str, name: str, given: dict[str, Any], kind: type[S]) -> S:
        for field in ("topic", "timeout", "priority"):
            if f"{name}.{field}" not in given:
                raise RuntimeError(f"the parameter '{group}.{name}.{field}' is missing")
        topic, timeout, priority = (given[f"{name}.{field}"] for field in ("topic", "timeout", "priority"))
        try:
            source = kind(name, str(topic), float(timeout), int(priority))
        except (TypeError, ValueError):
            raise RuntimeError(f"the timeout and the priority of '{group}.{name}' must be numbers") from None
        if source.timeout < 0 or not 0 <= source.priority <= 255:
            raise RuntimeError(
                f"'{group}.{name}' has timeout {source.timeout} and priority {source.priority}, "
                "but a timeout is at least 0 and a priority from 0 to 255"
            )
        return source

    def _now(self) -> float:
        return self.get_clock().now().nanoseconds * 1e-9

    def _forward_message(self, source: Source, message: Any) -> None:
        source.received_at = self._now()
        if active(self._sources, self._locks, source.received_at) is source:
            self._commands.publish(message)

    def _set_lock(self, lock: Lock, message: Bool) -> None:
        lock.received_at, lock.is_closed = self._now(), message.data

    def _notify(self, status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        now = self._now()
        limit, chosen = lock_priority(self._locks, now), active(self._sources, self._locks, now)
        status.summary(DiagnosticStatus.OK, "ok")
        for source in self._sources:
            state = "silent" if source.is_silent(now) else "masked" if source.priority <= limit else "unmasked"
            status.add(f"velocity {source.name}", _words(source, state))
        for lock in self._locks:
            status.add(f"lock {lock.name}", _words(lock, "locked" if lock.is_locked(now) else "free"))
        status.add("current priority", str(chosen.priority if chosen else limit))
        status.add("active velocity", chosen.name if chosen else "none")
        return status


def _words(source: Source, state: str) -> str:
    return f"{state} (listening to {source.topic} @ {source.timeout:g} s with priority #{source.priority})"
