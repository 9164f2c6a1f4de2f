"""Truck with driven rear wheels."""
