"""Descriptions of .msg, .srv and .action files, under rosidl's names."""
