"""Smoothers of planned paths."""
