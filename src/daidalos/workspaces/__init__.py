"""Workspaces: colcon packages that CMake would build, read without CMake, and the dependencies of packages."""
