"""Code generation from interface definitions, and their translation, under rosidl's names."""
