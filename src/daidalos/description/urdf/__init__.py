"""Reader of URDF and xacro: robots with all joints, meshes and extensions."""

from daidalos.description.urdf.reader import load, parse, read_robot

__all__ = ["load", "parse", "read_robot"]
