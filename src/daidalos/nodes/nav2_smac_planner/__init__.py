"""Commands of the Smac planners."""
