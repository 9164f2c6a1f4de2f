"""3-D view in the studio."""
