"""Topics and their messages, in the studio."""
