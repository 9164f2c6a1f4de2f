"""A node to ask about the graph."""

from __future__ import annotations

from argparse import ArgumentParser

from daidalos.cli.ros2.direct import add_graph_arguments
from ros2cli.node.direct import DirectNode


class NodeStrategy(DirectNode):
    """A node that knows the graph; it finds everybody so soon that it needs no daemon."""


def add_arguments(parser: ArgumentParser) -> None:
    """Declare the options of verbs that ask about the graph."""
    add_graph_arguments(parser)
