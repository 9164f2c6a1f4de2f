"""The module that stands for rclpy's compiled part, under the name by which programs reach for it."""

from rclpy import _rclpy_pybind11 as rclpy_implementation

__all__ = ["rclpy_implementation"]
