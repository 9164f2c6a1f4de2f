"""Nodes of the ROS executables, one file each, grouped by ROS package.

The executable ``map_server`` runs the function `main` of its module or, where there is none, the node ``MapServer``.
"""
