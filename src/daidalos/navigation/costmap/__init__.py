"""What the robot may touch: a grid of costs put together from layers."""
