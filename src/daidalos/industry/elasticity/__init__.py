"""Elasticity of arms: joint stiffness, backlash, friction, masses, and the deflection of a loaded tool."""
