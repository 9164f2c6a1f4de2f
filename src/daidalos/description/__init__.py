"""Robots and worlds as data: URDF, xacro, SDF and meshes, and forward kinematics."""
