"""Base classes and graph access for packages that add commands and verbs to `ros2`."""
