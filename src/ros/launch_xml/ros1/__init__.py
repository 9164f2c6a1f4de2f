"""Launch files of ROS 1: recognized, translated to those of ROS 2, and what was translated is said."""

from launch._lazy import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
