"""Tests of launched systems: some run while the processes do, others after they have ended."""

from launch._lazy import attach_stub

# A function with the name of its module: the function is what the package offers.
from .parametrize import parametrize as parametrize

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
