"""Control nodes, one class each."""
