"""Verbs that other packages add to `ros2 interface`: entry points of the group ``ros2interface.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
