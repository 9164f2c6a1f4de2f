"""Publishing messages by hand, in the studio."""
