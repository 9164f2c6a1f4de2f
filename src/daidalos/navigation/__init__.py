"""Costmaps, planners, controllers, smoothers and behaviours of a mobile robot."""
