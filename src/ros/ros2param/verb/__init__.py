"""Verbs that other packages add to `ros2 param`: entry points of the group ``ros2param.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
