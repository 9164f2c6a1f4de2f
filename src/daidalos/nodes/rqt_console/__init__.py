"""Log messages in the studio."""
