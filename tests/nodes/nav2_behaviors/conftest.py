"""The fixture that these tests use."""

from nodes.stepped import compiled

__all__ = ["compiled"]
