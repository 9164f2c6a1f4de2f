"""Critics of the MPPI controller, one class each."""
