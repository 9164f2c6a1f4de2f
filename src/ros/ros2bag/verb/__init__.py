"""Verbs that other packages add to `ros2 bag`: entry points of the group ``ros2bag.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
