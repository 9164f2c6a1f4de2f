"""A reader of CMakeLists.txt: what a package would install, found without running CMake."""
