"""Conversion of messages, and their classes by name."""
