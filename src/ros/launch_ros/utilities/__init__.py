"""Helpers for names, parameters and remappings."""

from launch._lazy import attach_stub

# Functions with the names of their modules: the functions are what the package offers.
from .evaluate_parameters import evaluate_parameters as evaluate_parameters
from .normalize_parameters import normalize_parameters as normalize_parameters
from .normalize_remap_rule import normalize_remap_rule as normalize_remap_rule
from .to_parameters_list import to_parameters_list as to_parameters_list

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
