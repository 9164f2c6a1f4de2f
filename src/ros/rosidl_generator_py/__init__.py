"""Generator of Python classes for `rosidl generate`, under rosidl's name."""
