"""Verbs that other packages add to `ros2 daemon`: entry points of the group ``ros2cli.daemon.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
