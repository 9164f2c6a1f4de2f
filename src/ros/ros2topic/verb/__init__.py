"""Verbs that other packages add to `ros2 topic`: entry points of the group ``ros2topic.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
