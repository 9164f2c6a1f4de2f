"""Tests of launched nodes: waiting for their topics, and changing their messages."""

from launch._lazy import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
