"""Plots in the studio."""
