"""The DDS middleware."""
