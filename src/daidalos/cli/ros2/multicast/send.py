"""`ros2 multicast send`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2multicast.api import DEFAULT_GROUP, DEFAULT_PORT, hops, send

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb


class SendVerb(Verb):
    """Send a single UDP multicast packet."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        parser.add_argument("--ttl", type=hops, help="The multicast TTL")

    def main(self, *, args: Namespace) -> Status:
        """Send a packet."""
        print("Sending one UDP multicast datagram...")
        try:
            send(b"Hello World!", ttl=args.ttl)
        except OSError as error:
            raise CliError(f"It cannot be sent to {DEFAULT_GROUP}:{DEFAULT_PORT}: {error.strerror}") from None
        return 0
