"""Nodes that change what their one child does or says."""
