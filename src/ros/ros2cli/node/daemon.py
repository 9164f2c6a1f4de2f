"""Daemon as a node: it answers questions about the graph without a discovery of our own."""

from __future__ import annotations

import argparse
import inspect
from functools import wraps
from types import TracebackType
from typing import TYPE_CHECKING, Any

from ros2cli.helpers import wait_for

if TYPE_CHECKING:
    from daidalos.transport.graph import Graph


class DaemonNode:
    """Node whose methods about the graph the daemon answers; they return lists where those of a node return tuples.

    Parameters
    ----------
    args
        What `add_arguments` declared.
    """

    def __init__(self, args: Any) -> None:
        self.system = _System()
        self.methods: list[str] = []

    @property
    def connected(self) -> bool:
        """Whether the daemon runs."""
        from ros2cli.daemon import client

        running = client.is_running()
        self.methods = sorted(_methods()) if running else []
        return running

    def __enter__(self) -> DaemonNode:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the use of the daemon, which goes on."""

    def __getattr__(self, name: str) -> Any:
        if name not in _methods():
            raise AttributeError(f"the daemon has no method '{name}'")
        method = getattr(_fetched(), name)

        @wraps(method)
        def call(*args: Any, **kwargs: Any) -> Any:
            return _listed(method(*args, **kwargs))

        return call


class _System:
    """Methods that concern the daemon itself."""

    def shutdown(self) -> None:
        """Stop the daemon."""
        from ros2cli.daemon import client

        client.stop()

    def listMethods(self) -> list[str]:
        """Return the names of the methods that the daemon answers, those of this class included."""
        own = (f"system.{name}" for name, _ in inspect.getmembers(self, inspect.ismethod) if not name.startswith("_"))
        return sorted((*_methods(), *own))

    def methodHelp(self, name: str) -> str:
        """Return the description of a method, empty for a name that is none."""
        from ros2cli.daemon.view import GraphView

        owner, method = (self, name[7:]) if name.startswith("system.") else (GraphView, name)
        return inspect.getdoc(getattr(owner, method)) or "" if name in self.listMethods() else ""

    def methodSignature(self, name: str) -> str:
        """Return that there are no signatures, as XML-RPC servers in Python answer."""
        return "signatures not supported"


def is_daemon_running(args: Any) -> bool:
    """Return whether the daemon runs; `args` is what `add_arguments` declared."""
    return DaemonNode(args).connected


def shutdown_daemon(args: Any, timeout: float | None = None) -> bool:
    """Stop the daemon.

    Parameters
    ----------
    args
        What `add_arguments` declared.
    timeout
        How long to wait for its end [s]; negative: without limit, None: not at all.

    Returns
    -------
    bool
        False if it did not run.

    Raises
    ------
    RuntimeError
        When it still runs after `timeout`.
    """
    node = DaemonNode(args)
    if not node.connected:
        return False
    node.system.shutdown()
    if timeout is not None and not wait_for(lambda: not node.connected, timeout):
        raise RuntimeError(f"the daemon did not stop within {timeout:g} s")
    return True


def spawn_daemon(args: Any, timeout: float | None = None, debug: bool = False) -> bool:
    """Start the daemon, and wait until it is ready unless `timeout` is None.

    Parameters
    ----------
    args
        What `add_arguments` declared.
    timeout
        None to start it in the background.
    debug
        Whether its messages go to our standard error.

    Returns
    -------
    bool
        False if it runs already.

    Raises
    ------
    RuntimeError
        When it does not start.
    """
    from ros2cli.daemon import client

    if client.is_running():
        return False
    if timeout is None and not debug:
        client.start_in_background()
    elif not client.start(debug):
        raise RuntimeError("the daemon could not be started; `ros2 daemon start --debug` shows why")
    return True


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of verbs that ask the daemon: there are none."""


def _methods() -> set[str]:
    from ros2cli.daemon.view import GraphView

    return {name for name, _ in inspect.getmembers(GraphView, inspect.isfunction) if not name.startswith("_")}


def _fetched() -> Any:
    from ros2cli.daemon import client
    from ros2cli.daemon.view import GraphView

    graph: Graph | None = client.fetch_graph()
    if graph is None:
        raise ConnectionRefusedError("the daemon does not run; `ros2 daemon start` starts it")
    return GraphView(graph)


def _listed(value: Any) -> Any:
    """Return a value with lists instead of plain tuples."""
    return [_listed(one) for one in value] if type(value) in (list, tuple) else value
