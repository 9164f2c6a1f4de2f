"""Verbs that other packages add to `ros2 pkg`: entry points of the group ``ros2pkg.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
