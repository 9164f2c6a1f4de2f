"""The graph for the browser studio, over the Foxglove WebSocket protocol."""
