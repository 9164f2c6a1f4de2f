"""Launch tests with nodes under pytest."""
