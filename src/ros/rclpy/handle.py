"""The exception that a destroyed handle raises, where programs look for it."""

from rclpy.impl.errors import InvalidHandle

__all__ = ["InvalidHandle"]
