"""Nodes and topics, and who talks to whom, in the studio."""
