"""Verbs that other packages add to `ros2 node`: entry points of the group ``ros2node.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
