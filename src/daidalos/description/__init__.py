"""Data model of robots and worlds: URDF, xacro, SDF and meshes, and forward kinematics."""
