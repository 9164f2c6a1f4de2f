"""Docking: types of docks, their database, and the approach to them."""
