"""URDF and xacro: robots with every joint, mesh and extension read."""

from daidalos.description.urdf.reader import load, parse, read_robot

__all__ = ["load", "parse", "read_robot"]
