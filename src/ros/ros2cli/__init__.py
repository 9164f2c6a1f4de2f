"""What packages need that add commands and verbs to `ros2`: base classes, and a node to ask the graph with."""
