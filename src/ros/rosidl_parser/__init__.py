"""Descriptions of interface types, under rosidl's names."""
