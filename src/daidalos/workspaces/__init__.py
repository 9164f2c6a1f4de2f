"""Workspaces: builds of colcon packages without CMake, and dependencies of packages."""
