"""Background process that keeps the graph discovered for commands, and its client."""
