"""Server's side of the rosbridge protocol, version 2: the graph for clients that speak JSON."""
