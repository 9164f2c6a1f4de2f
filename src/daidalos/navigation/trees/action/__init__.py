"""Leaves that have something done, one class each."""
