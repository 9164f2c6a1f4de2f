"""Nodes of robots that run programs in RAPID."""
