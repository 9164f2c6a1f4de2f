"""Parts of the MPPI controller: rollouts and the critics that judge them."""
