"""`ros2 component standalone`."""

from __future__ import annotations

import subprocess
from argparse import ArgumentParser, Namespace

from ros2cli.node.direct import direct_node
from ros2cli.node.strategy import add_arguments as add_graph_arguments

from daidalos.cli.ros2.containers import add_component_arguments, containers, load
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb

_START_S = 20.0
_END_S = 5.0


class StandaloneVerb(Verb):
    """Run a component into its own standalone container node."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_graph_arguments(parser)
        add_component_arguments(parser)
        parser.add_argument(
            "-c", "--container-node-name", default="standalone_container", help="Name of the container node to be run"
        )

    def main(self, *, args: Namespace) -> Status:
        """Run the component in its own container until Ctrl-C."""
        from daidalos.workspaces.executables import find_executable
        from daidalos.workspaces.orphans import guard

        rename = ["--ros-args", "-r", f"__node:={args.container_node_name}"]
        command = [*find_executable("rclcpp_components", "component_container"), *rename]
        process = subprocess.Popen(command)
        guard.watch(process.pid)
        try:
            container = f"/{args.container_node_name}"
            with direct_node(args) as node:
                graph = node.handle.graph
                if not graph.wait_for(lambda: container in containers(graph), _START_S):
                    raise CliError(f"The container node '{container}' did not start within {_START_S:g} s")
                load(node, container, args)
            return process.wait()
        finally:
            _end(process)
            guard.release(process.pid)


def _end(process: subprocess.Popen[bytes]) -> None:
    if process.poll() is None:
        process.terminate()
        try:
            process.wait(_END_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
