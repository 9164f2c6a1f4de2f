"""The stage that these tests use."""

from nodes.stepped import compiled, stage

__all__ = ["compiled", "stage"]
