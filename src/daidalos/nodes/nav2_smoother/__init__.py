"""Server that smooths paths."""
