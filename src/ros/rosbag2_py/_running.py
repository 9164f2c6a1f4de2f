"""A node that has a context of its own, a thread for its callbacks and the keys of the terminal."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any, Generic, TypeVar

from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.logging import LoggingSeverity
from rclpy.node import Node

from rosbag2_py._keyboard import Keyboard

NodeT = TypeVar("NodeT", bound=Node)


class RunningNode(Generic[NodeT]):
    """Owner of a node that it creates and runs.

    Parameters
    ----------
    make
        Makes the node in a context.
    level
        From which severity on it logs.
    threads
        How many threads its callbacks may use.
    keys
        What is done when a key is pressed in the terminal.
    on_crash
        Called when a callback raises; the exception goes on.

    Attributes
    ----------
    node
        The node.
    """

    def __init__(
        self,
        make: Callable[[Context], NodeT],
        level: LoggingSeverity,
        *,
        threads: int = 1,
        keys: Mapping[str, Callable[[NodeT], Any]] | None = None,
        on_crash: Callable[[], None] = lambda: None,
    ) -> None:
        self._context = Context()
        self._context.init(args=[])
        try:
            self.node = make(self._context)
        except BaseException:
            self._context.destroy()
            raise
        self.node.get_logger().set_level(level)
        self._executor = (
            SingleThreadedExecutor(context=self._context)
            if threads == 1
            else MultiThreadedExecutor(threads, context=self._context)
        )
        self._executor.add_node(self.node)
        self._on_crash = on_crash
        self._thread: threading.Thread | None = None
        self._keys = dict(keys or {})
        self._keyboard = Keyboard(self._on_key) if self._keys else None

    def _on_key(self, key: str) -> None:
        action = self._keys.get(key)
        if action is not None:
            action(self.node)

    def start(self) -> None:
        """Run callbacks from now on."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._spin, name=f"{self.node.get_name()} callbacks", daemon=True)
            self._thread.start()

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except ExternalShutdownException:
            return
        except BaseException:
            self._on_crash()
            raise

    def listen_to_keys(self, *help_lines: str) -> None:
        """Print what the keys do, and react to them."""
        if self._keyboard is not None:
            for line in help_lines:
                self.node.get_logger().info(line)
            self._keyboard.start()

    def ignore_keys(self) -> None:
        """Stop reacting to keys."""
        if self._keyboard is not None:
            self._keyboard.stop()

    def close(self) -> None:
        """Run no more callbacks, and leave the graph."""
        self._executor.shutdown()
        if self._thread is not None:
            self._thread.join()
        self.node.destroy_node()
        self._context.destroy()


class Runner(Generic[NodeT]):
    """Base of the player and the recorder: owner of a `RunningNode`, once there are options to make it with."""

    def __init__(self) -> None:
        self._running_node: RunningNode[NodeT] | None = None
        self._cancelled = threading.Event()

    @property
    def _configured(self) -> RunningNode[NodeT]:
        if self._running_node is None:
            raise RuntimeError(f"{type(self).__name__} is not configured: it was made without options")
        return self._running_node

    def start_spin(self) -> None:
        """Run the node's callbacks in a thread."""
        self._configured.start()

    def stop_spin(self) -> None:
        """Run no more callbacks, and leave the graph."""
        self._configured.close()
        self._running_node = None
