"""Running one node as a program."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rclpy.node import Node


class UserError(Exception):
    """A mistake of the user's: shown as one line, without a traceback, with exit status 2."""


def run(make_node: Callable[[], Node], args: Sequence[str] | None = None, threads: int = 1) -> int:
    """Initialise rclpy, make a node and spin it until the process is asked to end.

    Parameters
    ----------
    make_node
        Makes the node once rclpy is ready.
    args
        Command-line arguments; those of the process where None.
    threads
        How many callbacks may run at the same time.

    Returns
    -------
    int
        The exit status.
    """
    import rclpy
    from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor

    node: Any = None
    try:
        rclpy.init(args=list(args) if args is not None else None)
        node = make_node()
        executor = SingleThreadedExecutor() if threads == 1 else MultiThreadedExecutor(threads)
        executor.add_node(node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        return 0
    except (UserError, RuntimeError) as error:
        if isinstance(error, RuntimeError) and node is not None:
            raise
        print(f"error: {error}", file=sys.stderr)
        return 2
    finally:
        # Whoever asks twice must not interrupt the end.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0
