"""Costmaps as nodes."""
