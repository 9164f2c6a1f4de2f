"""Calling services by hand, in the studio."""
