"""Action nodes, one class each."""
