"""Bridge to gz, with both ends in one graph here."""
