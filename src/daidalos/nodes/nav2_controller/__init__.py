"""Server that follows paths."""
