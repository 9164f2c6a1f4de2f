"""`ros2 multicast send`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2 import datagrams
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb


class SendVerb(Verb):
    """Send a single UDP multicast packet."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        parser.add_argument("--ttl", type=datagrams.hops, help="The multicast TTL")

    def main(self, *, args: Namespace) -> Status:
        """Send a packet."""
        print("Sending one UDP multicast datagram...")
        try:
            datagrams.send(b"Hello World!", args.ttl)
        except OSError as error:
            raise CliError(f"It cannot be sent to {datagrams.GROUP}:{datagrams.PORT}: {error.strerror}") from None
        return 0
