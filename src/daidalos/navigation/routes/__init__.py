"""Routes over graphs of places: graph files, edge costs, search, dense paths, tracking and operations."""
