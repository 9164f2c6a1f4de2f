"""Condition nodes, one class each."""
