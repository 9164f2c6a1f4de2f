"""Dependencies of packages: which are available, and which the Python package index provides."""
