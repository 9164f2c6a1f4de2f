"""Samples of sensors and commands as dataclasses of arrays, with their messages."""
