"""Questions to the graph as services."""
