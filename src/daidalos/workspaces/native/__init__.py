"""C++ packages: the tools, the library ``rclcpp`` built once per compiler, and the build of a package by CMake."""
