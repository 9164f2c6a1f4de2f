"""The zenoh middleware."""
