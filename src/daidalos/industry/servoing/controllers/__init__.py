"""Seam controllers."""
