"""Execution of RAPID programs: translation to Python, values, predefined routines and the seam to a robot."""
