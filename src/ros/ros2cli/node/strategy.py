"""A node to ask about the graph."""

from __future__ import annotations

from argparse import ArgumentParser
from types import TracebackType
from typing import Any

from ros2cli.node import daemon, direct
from ros2cli.node.daemon import DaemonNode, is_daemon_running, spawn_daemon
from ros2cli.node.direct import DirectNode


class NodeStrategy:
    """A node that knows the graph: the daemon if it runs, else a node of our own, which also starts the daemon.

    It has the attributes of a node; for those that the daemon cannot answer a node of our own is made.

    Parameters
    ----------
    args
        What `add_arguments` declared.
    node_name
        The name of the node of our own; a hidden one where None.
    """

    def __init__(self, args: Any, *, node_name: str | None = None) -> None:
        self._args = args
        self._node_name = node_name
        self._in_scope = False
        self._daemon_node: DaemonNode | None = None
        self._direct_node: DirectNode | None = None
        use_daemon = not getattr(args, "no_daemon", False)
        if use_daemon and is_daemon_running(args):
            self._daemon_node = DaemonNode(args)
            if self._daemon_node.connected:
                return
            self._daemon_node = None
        elif use_daemon:
            spawn_daemon(args)
        self._direct_node = DirectNode(args, node_name=node_name)

    @property
    def daemon_node(self) -> DaemonNode | None:
        """The daemon, None where it did not run."""
        return self._daemon_node

    @property
    def direct_node(self) -> DirectNode:
        """The node of our own, made when first asked for."""
        if self._direct_node is None:
            self._direct_node = DirectNode(self._args, node_name=self._node_name)
            if self._in_scope:
                self._direct_node.__enter__()
        return self._direct_node

    def __enter__(self) -> NodeStrategy:
        if self._direct_node is not None:
            self._direct_node.__enter__()
        self._in_scope = True
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._in_scope = False
        if self._direct_node is not None:
            self._direct_node.__exit__(kind, error, trace)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        if self._daemon_node is not None and name in self._daemon_node.methods:
            return getattr(self._daemon_node, name)
        return getattr(self.direct_node, name)


def add_arguments(parser: ArgumentParser) -> None:
    """Declare the options of verbs that ask about the graph.

    Parameters
    ----------
    parser
        The verb's parser.
    """
    daemon.add_arguments(parser)
    direct.add_arguments(parser)
    parser.add_argument("--no-daemon", action="store_true", help="Do not spawn nor use an already running daemon")
