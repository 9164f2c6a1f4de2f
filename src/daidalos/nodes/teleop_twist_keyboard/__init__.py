"""Teleoperation with the letters of a keyboard."""
