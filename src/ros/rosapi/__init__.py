"""Questions to the graph, for clients that are not nodes themselves."""
