"""Verbs that other packages add to `ros2 lifecycle`: entry points of the group ``ros2lifecycle.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
