"""Simple motions that free a robot: spin, back up, wait."""
