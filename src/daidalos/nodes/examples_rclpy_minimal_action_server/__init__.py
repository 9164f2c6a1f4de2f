"""Minimal action servers, which differ in their handling of several goals."""

EXECUTABLES = {"server": "server", "server_not_composable": "server"}
