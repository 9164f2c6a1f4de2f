"""Values over time, in the studio."""
