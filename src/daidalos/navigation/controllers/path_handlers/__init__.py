"""Path handlers: how much of a plan a controller sees, one class each."""
