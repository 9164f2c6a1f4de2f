"""`ros2 control view_controller_chains`."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from argparse import Namespace
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.controllers import ControlVerb, ask
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status


class ViewControllerChainsVerb(ControlVerb):
    """Generates a diagram of the loaded chained controllers into /tmp/controller_diagram.gv.pdf."""

    def main(self, *, args: Namespace) -> Status:
        """Write the diagram, as a PDF if Graphviz is installed, and print its path."""
        from controller_manager_msgs.srv import ListControllers, ListHardwareInterfaces

        with direct_node(args) as node:
            controllers = ask(node, args, ListControllers)
            hardware = ask(node, args, ListHardwareInterfaces)
        print(parse_response(controllers, hardware))
        return 0


def parse_response(list_controllers_response: Any, list_hardware_response: Any, visualize: bool = True) -> str:
    """Write the diagram of a controller manager's responses, and return where it is.

    Parameters
    ----------
    list_controllers_response
        `controller_manager_msgs/srv/ListControllers`, the response.
    list_hardware_response
        `controller_manager_msgs/srv/ListHardwareInterfaces`, the response.
    visualize
        Whether to draw it as a PDF if Graphviz is installed.

    Raises
    ------
    CliError
        When Graphviz cannot draw it.
    """
    path = Path(tempfile.gettempdir()) / "controller_diagram.gv"
    path.write_text(diagram(list_controllers_response.controller, list_hardware_response), encoding="utf-8")
    program = shutil.which("dot") if visualize else None
    if program is None:
        return f"{path} (install Graphviz to have it drawn as a PDF)"
    pdf = path.with_suffix(".gv.pdf")
    drawn = subprocess.run([program, "-Tpdf", path, "-o", pdf], capture_output=True, text=True, check=False)
    if drawn.returncode:
        raise CliError(f"Graphviz cannot draw {path}: {drawn.stderr.strip()}")
    return str(pdf)


def diagram(controllers: Iterable[Any], hardware: Any) -> str:
    """Return a graph in Graphviz's language: controllers and hardware, connected by shared interfaces."""
    lines = ["digraph controllers {", "  rankdir=LR;", "  node [shape=box, style=rounded];"]
    lines += [
        '  "hardware: commands" [shape=cylinder, style=solid];',
        '  "hardware: states" [shape=cylinder, style=solid];',
    ]
    commands = {one.name for one in hardware.command_interfaces}
    states = {one.name for one in hardware.state_interfaces}
    for controller in controllers:
        label = rf"{controller.name}\n{controller.type}\n{controller.state}"
        lines.append(f"  {_quoted(controller.name)} [label={_quoted(label)}];")
        lines += (f"  {edge};" for edge in _edges(controller, commands, states))
    return "\n".join([*lines, "}", ""])


def _edges(controller: Any, commands: set[str], states: set[str]) -> Iterator[str]:
    name = _quoted(controller.name)
    for interface in controller.required_state_interfaces:
        source = "hardware: states" if interface in states else interface.split("/")[0]
        yield f"{_quoted(source)} -> {name} [label={_quoted(interface)}]"
    for interface in controller.required_command_interfaces:
        target = "hardware: commands" if interface in commands else interface.split("/")[0]
        yield f"{name} -> {_quoted(target)} [label={_quoted(interface)}]"


def _quoted(text: str) -> str:
    escaped = text.replace('"', r"\"")
    return f'"{escaped}"'
