"""`ros2 multicast receive`."""

from __future__ import annotations

from argparse import Namespace

from daidalos.cli.ros2 import datagrams
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb


class ReceiveVerb(Verb):
    """Receive a single UDP multicast packet."""

    def main(self, *, args: Namespace) -> Status:
        """Wait for a packet and print it."""
        print("Waiting for UDP multicast datagram...")
        try:
            with datagrams.open_receiver() as receiver:
                data, host, port = datagrams.receive(receiver)
        except OSError as error:
            raise CliError(f"{datagrams.GROUP}:{datagrams.PORT} cannot be listened to: {error.strerror}") from None
        print(f"Received from {host}:{port}: {data.decode(errors='replace')!r}")
        return 0
