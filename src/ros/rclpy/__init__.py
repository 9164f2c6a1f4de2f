"""ROS 2's client library for Python.

A program begins with `init`, makes a `Node` with publishers, subscriptions, services, clients, actions,
timers and parameters, has their callbacks run by `spin`, and ends with `shutdown`.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from daidalos.distribution import complete_environment as _complete_environment
from daidalos.distribution import complete_prefix_path as _complete_prefix_path
from rclpy.context import Context
from rclpy.parameter import Parameter
from rclpy.signals import (
    SignalHandlerOptions,
    install_signal_handlers,
    uninstall_signal_handlers,
    watch_context,
)
from rclpy.task import Future
from rclpy.utilities import get_default_context, get_rmw_implementation_identifier, ok, try_shutdown
from rclpy.utilities import shutdown as _shutdown

if TYPE_CHECKING:
    from rclpy.executors import Executor
    from rclpy.node import Node
    from rclpy.qos import QoSProfile

__all__ = [
    "Context",
    "Future",
    "InitContextManager",
    "Parameter",
    "SignalHandlerOptions",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "get_rmw_implementation_identifier",
    "init",
    "ok",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
]

# A program that was started without a setup file finds what the setup file of a ROS 2 installation sets.
_complete_environment()
_complete_prefix_path()

__executor: Executor | None = None


def __getattr__(name: str) -> Any:
    """Import a module of the package when it is first asked for: programs write ``rclpy.executors`` and the like."""
    if name.startswith("__") or find_spec(f"{__name__}.{name}") is None:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return import_module(f"{__name__}.{name}")


class InitContextManager:
    """Result of `init`: ``with rclpy.init():`` shuts down at its end."""

    def __init__(self, context: Context, owns_handlers: bool) -> None:
        self.context = context
        self._owns_handlers = owns_handlers

    def __enter__(self) -> InitContextManager:
        return self

    def __exit__(self, *exception: object) -> None:
        self.context.try_shutdown()
        if self._owns_handlers:
            uninstall_signal_handlers()


def init(
    *,
    args: Sequence[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> InitContextManager:
    """Initialize ROS communications for a context and install the signal handlers.

    Parameters
    ----------
    args
        Command-line arguments; those of the process where None.
    context
        The context; the default one where None.
    domain_id
        The number of the ROS domain; ``ROS_DOMAIN_ID`` where None.
    signal_handler_options
        Which signals to handle; where None, all with the default context and none with another.

    Returns
    -------
    InitContextManager
        Shuts the context down at the end of a ``with`` block.

    Raises
    ------
    RuntimeError
        When the context is initialized already, or an argument is not valid.
    """
    default = context is None
    target = get_default_context() if context is None else context
    if signal_handler_options is None:
        signal_handler_options = SignalHandlerOptions.ALL if default else SignalHandlerOptions.NO
    target.init(args, domain_id=domain_id)
    watch_context(target)
    install_signal_handlers(signal_handler_options)
    return InitContextManager(target, signal_handler_options != SignalHandlerOptions.NO)


def get_global_executor() -> Executor:
    """Return the executor that `spin` uses where none is given."""
    global __executor
    executor = __executor
    if executor is None or executor.context is not get_default_context():
        from rclpy.executors import SingleThreadedExecutor

        executor = __executor = SingleThreadedExecutor()
        get_default_context().on_shutdown(_reset_global_executor)
    return executor


def _reset_global_executor() -> None:
    global __executor
    if __executor is not None:
        __executor.wake()
        __executor = None


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Shut down a context.

    Parameters
    ----------
    context
        The context; the default one where None.
    uninstall_handlers
        Whether to uninstall the signal handlers; where None, only with the default context.

    Raises
    ------
    RuntimeError
        When the context is not initialized.
    """
    _shutdown(context=context)
    if uninstall_handlers or (uninstall_handlers is None and context is None):
        uninstall_signal_handlers()


def create_node(
    node_name: str,
    *,
    context: Context | None = None,
    cli_args: list[str] | None = None,
    namespace: str | None = None,
    use_global_arguments: bool = True,
    enable_rosout: bool = True,
    rosout_qos_profile: QoSProfile | int | None = None,
    start_parameter_services: bool = True,
    parameter_overrides: list[Parameter[Any]] | None = None,
    allow_undeclared_parameters: bool = False,
    automatically_declare_parameters_from_overrides: bool = False,
    enable_logger_service: bool = False,
) -> Node:
    """Return a new node; see `rclpy.node.Node`."""
    from rclpy.node import Node
    from rclpy.qos import qos_profile_rosout_default

    return Node(
        node_name,
        context=context,
        cli_args=cli_args,
        namespace=namespace,
        use_global_arguments=use_global_arguments,
        enable_rosout=enable_rosout,
        rosout_qos_profile=qos_profile_rosout_default if rosout_qos_profile is None else rosout_qos_profile,
        start_parameter_services=start_parameter_services,
        parameter_overrides=parameter_overrides,
        allow_undeclared_parameters=allow_undeclared_parameters,
        automatically_declare_parameters_from_overrides=automatically_declare_parameters_from_overrides,
        enable_logger_service=enable_logger_service,
    )


def spin_once(node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None) -> None:
    """Run one callback of a node; wait for it at most `timeout_sec` seconds (None: however long it takes)."""
    executor = executor or get_global_executor()
    added = executor.add_node(node)
    try:
        executor.spin_once(timeout_sec=timeout_sec)
    finally:
        if added:
            executor.remove_node(node)


def spin(node: Node, executor: Executor | None = None) -> None:
    """Run a node's callbacks until the context is shut down."""
    executor = executor or get_global_executor()
    added = executor.add_node(node)
    try:
        while executor.context.ok():
            executor.spin()
            if executor._is_shutdown:
                return
    finally:
        if added:
            executor.remove_node(node)


def spin_until_future_complete(
    node: Node, future: Future, executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Run a node's callbacks until a future is done or cancelled, for at most `timeout_sec` seconds."""
    executor = executor or get_global_executor()
    added = executor.add_node(node)
    try:
        executor.spin_until_future_complete(future, timeout_sec)
    finally:
        if added:
            executor.remove_node(node)
