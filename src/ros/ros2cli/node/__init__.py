"""Nodes that commands take part in the graph with."""

NODE_NAME_PREFIX = "_ros2cli"
"""Beginning of the names of such nodes; a leading underscore hides them from listings."""
