"""The launch's own ROS node, which is only started when something needs it."""

from __future__ import annotations

import asyncio
import os
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from launch.event_handlers import OnShutdown

if TYPE_CHECKING:
    from launch import LaunchContext


class ROSAdapter:
    """A ROS context with a node that is spun in a thread.

    Parameters
    ----------
    argv
        Arguments for ROS.
    autostart
        Whether to start it at once.
    """

    def __init__(self, *, argv: list[str] | None = None, autostart: bool = True) -> None:
        self.__argv = [] if argv is None else list(argv)
        self.__ros_context: Any = None
        self.__ros_node: Any = None
        self.__ros_executor: Any = None
        self.__thread: threading.Thread | None = None
        self._users: list[asyncio.Future[None]] = []
        self._stopping = False
        if autostart:
            self.start()

    def start(self) -> None:
        """Start the node.

        Raises
        ------
        RuntimeError
            If it was started already.
        """
        if self.__thread is not None:
            raise RuntimeError("Cannot start a ROS adapter that is already running")
        # A launch that needs no ROS node does not pay for one.
        import rclpy
        import rclpy.context
        import rclpy.executors
        import rclpy.signals

        self.__ros_context = rclpy.context.Context()
        rclpy.init(
            args=self.__argv,
            context=self.__ros_context,
            # Signals are the launch service's.
            signal_handler_options=rclpy.signals.SignalHandlerOptions.NO,
        )
        self.__ros_node = rclpy.create_node(f"launch_ros_{os.getpid()}", context=self.__ros_context)
        self.__ros_executor = rclpy.executors.SingleThreadedExecutor(context=self.__ros_context)
        self.__ros_executor.add_node(self.__ros_node)
        self.__thread = threading.Thread(target=self.__spin, daemon=True)
        self.__thread.start()

    def __spin(self) -> None:
        from rclpy.executors import ExternalShutdownException, ShutdownException

        try:
            self.__ros_executor.spin()
        except (ExternalShutdownException, ShutdownException):
            return

    def shutdown(self) -> None:
        """Stop the node.

        Raises
        ------
        RuntimeError
            If it does not run.
        """
        if self.__thread is None:
            raise RuntimeError("Cannot shutdown a ROS adapter that is not running")
        self.__ros_executor.shutdown()
        self.__ros_context.try_shutdown()
        self.__thread.join()
        self.__ros_node.destroy_node()
        self.__thread = None

    @property
    def argv(self) -> list[str]:
        """The arguments for ROS."""
        return self.__argv

    @property
    def ros_context(self) -> Any:
        """The ROS context."""
        return self.__ros_context

    @property
    def ros_node(self) -> Any:
        """The node."""
        return self.__ros_node

    @property
    def ros_executor(self) -> Any:
        """The executor that spins the node."""
        return self.__ros_executor


def get_ros_adapter(context: LaunchContext) -> ROSAdapter:
    """Return the launch's adapter; the first call starts it, and it is stopped with the launch."""
    adapter = context.get_locals_as_dict().get("ros_adapter")
    if adapter is None:
        adapter = ROSAdapter(argv=context.argv)
        context.extend_globals({"ros_adapter": adapter})
        context.register_event_handler(
            OnShutdown(on_shutdown=lambda event, launch_context: _stop(adapter, launch_context))
        )
    return adapter


def get_ros_node(context: LaunchContext) -> Any:
    """Return the launch's own node."""
    return get_ros_adapter(context).ros_node


def run_with_ros_node(context: LaunchContext, function: Callable[..., None], *args: Any) -> asyncio.Future[None]:
    """Run a function that uses the launch's own node in a thread; the node is there until it has returned.

    Parameters
    ----------
    context
        The launch context.
    function, args
        What to call. It must return soon after the context says that the launch is being stopped.
    """
    future = context.running_loop.run_in_executor(None, function, *args)
    get_ros_adapter(context)._users.append(future)
    return future


def _stop(adapter: ROSAdapter, context: LaunchContext) -> None:
    if adapter._stopping:  # a process whose end shuts the launch down may end in the course of a shutdown
        return
    adapter._stopping = True
    context.add_completion_future(context.running_loop.create_task(_stop_when_unused(adapter)))


async def _stop_when_unused(adapter: ROSAdapter) -> None:
    if adapter._users:
        await asyncio.wait(adapter._users)
    # Stopping waits for the node's thread, which may just be calling into the launch.
    await asyncio.get_running_loop().run_in_executor(None, adapter.shutdown)
