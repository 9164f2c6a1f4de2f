"""Grids, scan matching, pose graphs and map files."""
