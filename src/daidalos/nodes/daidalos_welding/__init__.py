"""Nodes of welding robots."""
