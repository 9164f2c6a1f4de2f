"""Containers of several nodes in one process."""
