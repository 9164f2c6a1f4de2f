"""Transforms of a robot from its joint states."""
