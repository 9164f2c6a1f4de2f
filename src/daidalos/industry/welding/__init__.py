"""Friction stir welding with arms: seams, path correction by elasticity, programs, and experiments in simulation."""
