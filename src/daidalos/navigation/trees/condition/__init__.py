"""Leaves that answer a question, one class each."""
