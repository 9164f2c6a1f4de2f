"""Costmaps: grids of costs, combined from layers."""
