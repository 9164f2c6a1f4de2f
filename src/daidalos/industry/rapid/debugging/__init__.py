"""Debugging of programs in RAPID: breakpoints, steps, data, and the Debug Adapter Protocol."""
