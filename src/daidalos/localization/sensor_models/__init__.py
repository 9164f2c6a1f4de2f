"""How likely a scan is at a pose."""
