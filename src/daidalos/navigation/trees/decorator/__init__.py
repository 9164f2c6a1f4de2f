"""Decorators, one class each."""
