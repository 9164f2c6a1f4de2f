"""Verbs that other packages add to `ros2 service`: entry points of the group ``ros2service.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
