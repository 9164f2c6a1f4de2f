"""Nodes of moving heads."""
