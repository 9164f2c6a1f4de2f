"""Parts of the DWB controller: trajectories, their generation and their critics."""
