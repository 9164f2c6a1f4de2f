"""Conversion of model descriptions to MuJoCo's model specification."""
