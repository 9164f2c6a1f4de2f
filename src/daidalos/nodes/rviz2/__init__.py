"""The robot's world in 3-D, in the studio."""
