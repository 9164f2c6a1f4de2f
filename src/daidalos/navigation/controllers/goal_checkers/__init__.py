"""What decides that a goal is reached."""
