"""Parameters of nodes, in the studio."""
