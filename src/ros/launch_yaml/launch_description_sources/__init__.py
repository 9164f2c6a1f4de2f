"""Launch files in YAML as sources of launch descriptions."""

from launch._lazy import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
