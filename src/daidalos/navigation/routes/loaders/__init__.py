"""Readers of graph files, one class each."""
