"""What is behind a context: its arguments and its membership in the graph."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable, Sequence

from daidalos.transport import shared
from daidalos.transport.environment import Environment, read_environment
from daidalos.transport.session import Session
from rclpy.impl.arguments import RosArguments, parse
from rclpy.impl.errors import RCLError
from rclpy.impl.handle import Destroyable


class ContextHandle(Destroyable):
    """An initialised context; valid until `shutdown`.

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
        self._lock = threading.Lock()
        self._ok = True
        self._on_shutdown: list[weakref.ref[Callable[[], None]]] = []

    def ok(self) -> bool:
        """Tell whether the context is still valid."""
        return self._ok

    def get_domain_id(self) -> int:
        """Return the domain."""
        return self.environment.domain

    def on_shutdown(self, callback: Callable[[], None]) -> None:
        """Call a bound method when the context is shut down; it is not kept alive by that."""
        reference = weakref.WeakMethod(callback) if hasattr(callback, "__self__") else weakref.ref(callback)
        self._on_shutdown.append(reference)

    def shutdown(self) -> None:
        """Make the context invalid and wake everyone who waits on it.

        Raises
        ------
        RCLError
            When it was shut down before.
        """
        if not self.try_shutdown():
            raise RCLError("failed to shutdown: rcl_shutdown already called on the given context")

    def try_shutdown(self) -> bool:
        """Shut down unless that was done before; tell whether it was done now."""
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

    def _destroy(self) -> None:
        self.try_shutdown()
        shared.release(self.environment)
