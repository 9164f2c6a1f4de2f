"""Assistance systems: lights and projectors that show a worker the next step, and work sequences."""
