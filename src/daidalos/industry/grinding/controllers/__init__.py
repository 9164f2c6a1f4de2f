"""Force controllers, one a file."""
