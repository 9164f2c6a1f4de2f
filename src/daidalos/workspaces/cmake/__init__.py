"""Interpreter of CMakeLists.txt that determines what a package installs without running CMake."""
