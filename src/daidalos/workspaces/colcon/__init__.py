"""The extension of colcon: packages of build type ament_cmake, where there is no ament_cmake."""
