"""Bridge of the graph to the studio over the Foxglove WebSocket protocol."""
