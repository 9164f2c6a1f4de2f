"""Finding a robot's pose in a known map."""
