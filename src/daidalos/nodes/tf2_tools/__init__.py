"""Drawings of the tree of frames."""
