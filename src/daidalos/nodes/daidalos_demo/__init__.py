"""Trying out the demonstration: goals for its robot, and how well it did."""
