"""SLAM."""

COMPONENTS = {"AsynchronousSlamToolbox": "async_slam_toolbox_node:SlamToolbox"}
