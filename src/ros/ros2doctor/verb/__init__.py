"""Verbs that other packages add to `ros2 doctor`: entry points of the group ``ros2doctor.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
