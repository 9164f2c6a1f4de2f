"""Graph of nodes and topics in the studio."""
