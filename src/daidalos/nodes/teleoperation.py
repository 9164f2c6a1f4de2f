"""Runner of nodes controlled by keys: the keys in the main thread, callbacks in another."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, TypeVar

from daidalos.nodes.keyboard import Keyboard
from daidalos.nodes.runner import create, run_program

if TYPE_CHECKING:
    from rclpy.node import Node

    NodeT = TypeVar("NodeT", bound=Node)


def run_with_keyboard(make_node: Callable[[], NodeT], steer: Callable[[NodeT, Keyboard], None]) -> int:
    """Spin a node while keys steer it.

    Ctrl-C and termination end the keys before they end the graph, so that the last word can be to stand still.

    Parameters
    ----------
    make_node
        Makes the node once rclpy is ready.
    steer
        Reads keys and acts on them, until `Keyboard.read` returns None or the user has enough.

    Returns
    -------
    int
        The exit status.
    """
    import rclpy
    from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
    from rclpy.impl.signal_watch import start as start_watching
    from rclpy.impl.signal_watch import watched
    from rclpy.signals import SignalHandlerOptions

    def body() -> None:
        keyboard = Keyboard()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, watched(lambda *_: keyboard.wake()))
        start_watching()
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        node = create(make_node)
        executor = SingleThreadedExecutor()
        executor.add_node(node)

        def spin() -> None:
            with suppress(ExternalShutdownException):
                executor.spin()

        spinner = threading.Thread(target=spin, name="spin")
        with keyboard:
            spinner.start()
            try:
                steer(node, keyboard)
            finally:
                executor.shutdown()
                spinner.join()
                node.destroy_node()

    return run_program(body)
