"""Validators of the trajectory that the MPPI controller has chosen, one class each."""
