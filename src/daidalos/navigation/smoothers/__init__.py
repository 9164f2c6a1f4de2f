"""Paths with fewer kinks than the planner left."""
