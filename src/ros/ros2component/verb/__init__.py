"""Verbs that other packages add to `ros2 component`: entry points of the group ``ros2component.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
