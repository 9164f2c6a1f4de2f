"""A small robot on wheels that walks in circles."""
