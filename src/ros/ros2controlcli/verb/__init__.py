"""Verbs that other packages add to `ros2 control`: entry points of the group ``ros2controlcli.verb``."""

from ros2cli.verb import VerbExtension as VerbExtension
