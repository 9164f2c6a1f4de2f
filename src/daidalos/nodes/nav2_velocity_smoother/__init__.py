"""Velocity smoother between what commands a robot and what drives it."""

COMPONENTS = {"VelocitySmoother": "velocity_smoother:VelocitySmootherNode"}
