"""Nodes of a graph in one process under a stepped clock: one thread runs at a time, in an order that time decides."""
