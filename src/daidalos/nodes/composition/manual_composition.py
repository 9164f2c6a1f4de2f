"""`manual_composition`: talker, listener, server and client, named in the program, in one process."""

from __future__ import annotations

from daidalos.nodes.composition._components import Client, Listener, Server, Talker
from daidalos.nodes.composition._together import run_together


def main() -> int:
    """Run the nodes."""
    return run_together([Talker, Listener, Server, Client])
