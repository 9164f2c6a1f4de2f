"""The action server and client of the tutorials."""
