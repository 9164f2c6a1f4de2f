"""Humanoid that curls its arms."""
