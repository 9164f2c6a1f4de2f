"""The critics of the MPPI controller, one class each."""
