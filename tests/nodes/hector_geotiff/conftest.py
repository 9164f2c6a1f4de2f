"""The stage that these tests use."""

from nodes.stepped import stage

__all__ = ["stage"]
