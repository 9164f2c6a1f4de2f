"""Costmap nodes."""
