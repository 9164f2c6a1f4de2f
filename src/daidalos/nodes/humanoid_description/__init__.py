"""A humanoid that curls its arms."""
