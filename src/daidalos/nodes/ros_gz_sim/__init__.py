"""Simulator with the interface of ros_gz_sim."""

COMPONENTS = {"GzServer": "gzserver:GzServer"}
