"""Running one node as a program."""

from __future__ import annotations

import gc
import io
import signal
import sys
import threading
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, TypeVar

from daidalos.common.errors import UserError as UserError

if TYPE_CHECKING:
    from rclpy.context import Context
    from rclpy.executors import Executor
    from rclpy.node import Node

    NodeT = TypeVar("NodeT", bound=Node)


_failed = threading.Event()


def program_arguments() -> list[str]:
    """Return the arguments of the command line without those of ROS, such as remappings."""
    from rclpy.utilities import remove_ros_args

    return remove_ros_args(sys.argv)[1:]


def run_program(body: Callable[[], None], interrupted: int = 0) -> int:
    """Carry out a program that uses rclpy, and end it cleanly however it ends.

    Parameters
    ----------
    body
        Does the work; it may raise `UserError`, and be interrupted.
    interrupted
        The exit status after Ctrl-C.

    Returns
    -------
    int
        The exit status.
    """
    import rclpy
    from rclpy.exceptions import NotInitializedException
    from rclpy.signals import is_orderly

    from daidalos.nodes.asset_folders import record_named_files

    record_named_files(sys.argv[1:])
    try:
        body()
    except (UserError, NotInitializedException) as error:
        # What a program waited for did not come because it was asked to end.
        if rclpy.get_default_context().ended_by_signal:
            return interrupted
        if not isinstance(error, UserError):
            raise
        print(f"error: {error}", file=sys.stderr)
        return 2
    except BrokenPipeError:  # the reader of the output has closed it, such as `head`
        sys.stdout = io.StringIO()  # nothing is left to be written at the end
        return 1
    except BaseException as error:
        if not is_orderly(error):
            raise
        return 1 if _failed.is_set() else interrupted
    finally:
        ignore_interrupts()
        rclpy.try_shutdown()
    return 0


def fail() -> None:
    """End this process as an error in the main thread would."""
    _failed.set()
    signal.raise_signal(signal.SIGTERM)


def ignore_interrupts() -> None:
    """Ignore further Ctrl-C during the shutdown."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def create(make_node: Callable[[], NodeT]) -> NodeT:
    """Create a node, and warn of parameters given to it that it does not declare.

    Raises
    ------
    UserError
        When the node cannot be created, such as for a value that is not allowed.
    """
    from rclpy.lifecycle import LifecycleNode

    from daidalos.nodes.parameters import warn_of_undeclared

    try:
        node = make_node()
    except RuntimeError as error:
        raise UserError(str(error)) from error
    if not isinstance(node, LifecycleNode):  # which declares more when it is configured
        warn_of_undeclared(node)
    return node


def run(make_node: Callable[[], Node], args: Sequence[str] | None = None, threads: int = 1) -> int:
    """Initialize rclpy, make a node and spin it until the process is asked to end.

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

    def body() -> None:
        rclpy.init(args=list(args) if args is not None else None)
        node = create(make_node)
        gc.freeze()  # what is there stays: to look through the modules again and again takes 30 ms each time
        try:
            executor = make_executor(threads)
            executor.add_node(node)
            executor.spin()
        finally:
            ignore_interrupts()
            node.destroy_node()

    return run_program(body)


def make_executor(threads: int, context: Context | None = None) -> Executor:
    """Return an executor that runs so many callbacks at a time, in the default context where None."""
    from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor

    if threads == 1:
        return SingleThreadedExecutor(context=context)
    return MultiThreadedExecutor(threads, context=context)
