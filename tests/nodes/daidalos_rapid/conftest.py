"""The graph that these tests use."""

from ros.graph import graph, node

__all__ = ["graph", "node"]
