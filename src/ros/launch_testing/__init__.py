"""Tests of launched systems: some run while the processes do, others after they have ended."""

from launch._lazy import attach_stub

# Functions with the names of their modules: the functions are what the package offers.
from .parametrize import parametrize as parametrize
from .ready_to_test_action_timeout import ready_to_test_action_timeout as ready_to_test_action_timeout

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
