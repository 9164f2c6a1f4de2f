"""Implementation of contexts: arguments and membership in the graph."""

from __future__ import annotations

import sys
import threading
import weakref
from collections.abc import Callable, Sequence
from typing import Protocol

from daidalos.transport import shared
from daidalos.transport.environment import Environment, read_environment
from daidalos.transport.session import Session
from rclpy.impl.arguments import RosArguments, parse
from rclpy.impl.errors import RCLError
from rclpy.impl.handle import Destroyable
from rclpy.impl.interrupts import uninterrupted


class GraphMember(Protocol):
    """What leaves the graph with a context: the handle of a node."""

    def retire(self) -> None:
        """Leave the graph; the handle stays, and reaches no other node."""


class ContextHandle(Destroyable):
    """An initialized context; valid until `shutdown`.

    Raises
    ------
    UnknownROSArgsError, RCLInvalidROSArgsError
        For arguments that cannot be understood.
    EnvironmentVariableError
        When ROS_DOMAIN_ID or the like holds what it may not.
    """

    def __init__(self, arguments: Sequence[str], domain_id: int | None) -> None:
        super().__init__()
        self.arguments: RosArguments = parse(arguments)
        self.environment: Environment = read_environment(domain=domain_id)
        self.session: Session = shared.acquire(self.environment)
        self._lock = threading.RLock()  # a signal may come while it is held
        self._ok = True
        self._released = False
        self._nodes: weakref.WeakKeyDictionary[GraphMember, None] = weakref.WeakKeyDictionary()  # in order
        self._on_shutdown: list[weakref.ref[Callable[[], None]]] = []

    def ok(self) -> bool:
        """Return whether the context is still valid."""
        return self._ok

    @property
    def is_released(self) -> bool:
        """Whether the graph has been left."""
        return self._released

    def own(self, node: GraphMember) -> None:
        """Register a node that leaves the graph with the context."""
        self._nodes[node] = None

    def get_domain_id(self) -> int:
        """Return the domain."""
        return self.environment.domain

    def on_shutdown(self, callback: Callable[[], None]) -> None:
        """Call a bound method when the context is shut down; it is not kept alive by that."""
        reference = weakref.WeakMethod(callback) if hasattr(callback, "__self__") else weakref.ref(callback)
        self._on_shutdown.append(reference)

    def shutdown(self) -> None:
        """Invalidate the context and wake all threads that wait on it.

        Raises
        ------
        RCLError
            When it was shut down before.
        """
        if not self.try_shutdown():
            raise RCLError("failed to shutdown: rcl_shutdown already called on the given context")

    def try_shutdown(self) -> bool:
        """Shut down unless that was done before; return whether it was done now."""
        with self._lock:
            if not self._ok:
                return False
            self._ok = False
        for reference in self._on_shutdown:
            callback = reference()
            if callback:
                callback()
        self.session.graph.notify()
        return True

    def release(self) -> None:
        """Leave the graph with every node, after a shutdown. Not for signal handlers: it takes locks."""
        with self._lock:
            if self._released:
                return
            self._released = True
        with uninterrupted():
            for node in list(self._nodes):
                node.retire()
            shared.release(self.environment)

    def _destroy(self) -> None:
        self.try_shutdown()
        self.release()

    def __del__(self) -> None:
        if getattr(self, "_released", True) or sys.is_finalizing():
            return
        shared.abandon(self.environment)
