"""Scorers of edges, one class each."""
