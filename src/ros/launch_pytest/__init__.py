"""Tests of launched systems as ordinary pytest functions, coroutines and generators."""

from launch._lazy import attach_stub

# A function with the name of its module: the function is what the package offers.
from .fixture import fixture as fixture

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
