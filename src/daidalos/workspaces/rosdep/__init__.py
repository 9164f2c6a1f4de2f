"""What packages depend on: which of it is here, and which can be had from the Python package index."""
