"""The bridge to gz, which here has both ends in one graph."""
