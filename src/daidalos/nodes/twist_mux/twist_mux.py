"""`twist_mux`: forwards the velocities of the active source with the highest priority."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import partial
from typing import Any, TypeVar

from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import DiagnosticStatusWrapper, Updater
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import Bool

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare, given_below
from daidalos.nodes.runner import UserError
from daidalos.nodes.twist_mux._priorities import Lock, Source, active, lock_priority

S = TypeVar("S", bound=Source)


@dataclass(frozen=True)
class SourceParameters(Parameters):
    """Parameters of a source of velocities below ``topics.<name>``, and of a lock below ``locks.<name>``.

    A lock is a topic of std_msgs/Bool; it locks all sources up to its priority while it is true or silent.
    """

    topic: str = parameter("", "Topic to subscribe to.", not_empty=True)
    timeout: float = parameter(
        0.0, "How long the last message counts; 0 for ever.", unit="s", minimum=0.0, takes_integer=True
    )
    priority: int = parameter(0, "The higher, the sooner the source counts.", minimum=0, maximum=255)


@dataclass(frozen=True)
class TwistMuxParameters(Parameters):
    """Parameters of ``twist_mux``, beside those of its sources and locks."""

    use_stamped: bool = parameter(False, "Whether the velocities are TwistStamped instead of Twist.")


class TwistMux(Node):
    """Node that publishes ``cmd_vel_out``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("twist_mux", **kwargs)
        kind = TwistStamped if declare(self, TwistMuxParameters).use_stamped else Twist
        self._sources = self._read("topics", Source)
        self._locks = self._read("locks", Lock)
        if not self._sources:
            raise UserError("twist_mux needs sources: parameters such as 'topics.navigation.topic'")
        self._commands: Publisher = self.create_publisher(kind, "cmd_vel_out", 10)
        for source in self._sources:
            self.create_subscription(kind, source.topic, partial(self._forward_message, source), 10)
        for lock in self._locks:
            self.create_subscription(Bool, lock.topic, partial(self._set_lock, lock), 10)
        self._diagnostics = Updater(self)
        self._diagnostics.setHardwareID("none")
        self._diagnostics.add("Twist mux status", self._notify)

    def _read(self, group: str, kind: type[S]) -> list[S]:
        given = given_below(self, group)
        sources = []
        for name in dict.fromkeys(one.rpartition(".")[0] for one in given):
            for one in fields(SourceParameters):
                if f"{name}.{one.name}" not in given:
                    raise UserError(f"the parameter '{group}.{name}.{one.name}' is missing")
            settings = declare(self, SourceParameters, f"{group}.{name}")
            sources.append(kind(name, settings.topic, settings.timeout, settings.priority))
        return sources

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
