"""Planners of paths from a pose to a goal over a costmap."""
