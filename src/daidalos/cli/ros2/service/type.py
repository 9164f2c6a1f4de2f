"""`ros2 service type`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace

from daidalos.cli.ros2.completion import complete_services
from daidalos.cli.ros2.direct import graph_view
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import absolute, services, types_of
from daidalos.cli.ros2.suggestions import hint_line


class TypeVerb(Verb):
    """Output a service's type."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        complete_services(
            parser.add_argument(
                "service_name", help="Name of the ROS service to get type (e.g. '/talker/list_parameters')"
            )
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the types; the status is 1 when the service is not there."""
        name = absolute(args.service_name)
        with graph_view(args) as graph:
            known = services(graph)
        types = types_of(known, name)
        for one in types:
            print(one)
        if not types:
            sys.stderr.write(hint_line(name, (other for other, _ in known)))
        return 0 if types else 1
