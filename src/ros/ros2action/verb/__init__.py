"""Verbs that other packages add to `ros2 action`: entry points of the group ``ros2action.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
