"""`ros2 multicast receive`."""

from __future__ import annotations

from argparse import Namespace

from ros2multicast.api import DEFAULT_GROUP, DEFAULT_PORT, open_receiver, receive_from

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb


class ReceiveVerb(Verb):
    """Receive a single UDP multicast packet."""

    def main(self, *, args: Namespace) -> Status:
        """Wait for a packet and print it."""
        print("Waiting for UDP multicast datagram...")
        try:
            with open_receiver() as receiver:
                data, (host, port) = receive_from(receiver)
        except OSError as error:
            raise CliError(f"{DEFAULT_GROUP}:{DEFAULT_PORT} cannot be listened to: {error.strerror}") from None
        print(f"Received from {host}:{port}: {data.decode(errors='replace')!r}")
        return 0
