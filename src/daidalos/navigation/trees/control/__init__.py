"""Nodes that choose which of their children to tick."""
