"""The server that plans paths."""
