"""Bringing managed nodes up and down together."""
