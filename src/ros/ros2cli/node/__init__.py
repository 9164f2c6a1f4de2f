"""Nodes that commands take part in the graph with."""

from daidalos.cli.ros2.direct import NODE_NAME_PREFIX as NODE_NAME_PREFIX
