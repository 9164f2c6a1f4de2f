"""What nodes log, in the studio."""
