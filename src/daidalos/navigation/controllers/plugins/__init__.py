"""What decides that a goal is reached and that a robot makes progress."""
