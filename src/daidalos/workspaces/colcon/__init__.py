"""colcon extension that builds packages of build type ament_cmake where ament_cmake is not installed."""
