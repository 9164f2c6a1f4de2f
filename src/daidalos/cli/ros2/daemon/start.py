"""`ros2 daemon start`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from ros2cli.daemon import client

from daidalos.cli.ros2.extension import Status, Verb


class StartVerb(Verb):
    """Start the daemon if it isn't running."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        parser.add_argument("-d", "--debug", action="store_true", help="Print debug messages")

    def main(self, *, args: Namespace) -> Status:
        """Start the daemon, or keep the running one."""
        if client.keep():
            print("The daemon is already running")
        elif client.start(args.debug):
            print("The daemon has been started")
        else:
            return "The daemon could not be started; `ros2 daemon start --debug` shows why"
        return 0
