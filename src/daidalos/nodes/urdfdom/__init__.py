"""Commands that look at robot descriptions."""
