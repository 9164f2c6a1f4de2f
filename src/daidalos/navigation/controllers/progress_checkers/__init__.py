"""What decides that a robot makes progress."""
