"""Fixtures of the tests of nodes."""

from nodes.stepped_terminal import terminal

__all__ = ["terminal"]
