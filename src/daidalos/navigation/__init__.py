"""Costmaps, planners, controllers, smoothers and behaviors of mobile robots."""
