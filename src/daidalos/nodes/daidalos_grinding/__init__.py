"""Nodes of robotic grinding."""
