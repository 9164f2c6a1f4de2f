"""Verbs that other packages add to `ros2 multicast`: entry points of the group ``ros2multicast.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
