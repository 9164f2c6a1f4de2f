"""Containers that several nodes share a process in."""
