"""Server that drives through waypoints and carries out a task at each."""
