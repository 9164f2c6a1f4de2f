"""Driving a robot with the letters of a keyboard."""
