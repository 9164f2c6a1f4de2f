"""Layers of costmaps, one class each."""
