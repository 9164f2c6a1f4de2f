"""Turtles that follow each other by transforms."""
