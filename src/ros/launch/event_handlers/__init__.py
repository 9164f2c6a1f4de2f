"""Reactions to what happens while launching."""

from launch._lazy import attach_stub

# A function with the name of its module: the function is what the package offers.
from .event_named import event_named as event_named

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
