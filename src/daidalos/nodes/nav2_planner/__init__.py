"""Server that plans paths."""
