"""The server that follows paths."""
