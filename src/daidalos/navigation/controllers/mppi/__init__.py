"""Parts of the MPPI controller: rollouts and critics."""
