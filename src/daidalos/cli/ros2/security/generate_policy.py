"""`ros2 security generate_policy`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path

from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph_view import graph_view
from daidalos.cli.ros2.keystore.policy import policy_of


class GeneratePolicyVerb(Verb):
    """Generate XML policy file from ROS graph data."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        parser.add_argument("POLICY_FILE_PATH", type=Path, help="path of the policy xml file")

    def main(self, *, args: Namespace) -> Status:
        """Write the policy that allows what the nodes currently do."""
        with graph_view(args) as graph:
            text = policy_of(graph)
        try:
            args.POLICY_FILE_PATH.write_text(text, encoding="utf-8")
        except OSError as error:
            raise CliError(f"{args.POLICY_FILE_PATH}: {error.strerror}") from None
        return 0
