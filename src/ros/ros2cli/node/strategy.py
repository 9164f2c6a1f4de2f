"""A node to ask about the graph."""

from __future__ import annotations

from argparse import ArgumentParser

from ros2cli.node import direct
from ros2cli.node.direct import DirectNode


class NodeStrategy(DirectNode):
    """A node that knows the graph; its discovery is so quick that it needs no daemon."""


def add_arguments(parser: ArgumentParser) -> None:
    """Declare the options of verbs that ask about the graph.

    Parameters
    ----------
    parser
        The verb's parser.
    """
    direct.add_arguments(parser)
    parser.add_argument("--no-daemon", action="store_true", help="Do not spawn nor use an already running daemon")
