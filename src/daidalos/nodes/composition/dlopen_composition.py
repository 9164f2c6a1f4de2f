"""`dlopen_composition`: components in one process, by the names of the libraries that hold them in ROS 2."""

from __future__ import annotations

import re
from pathlib import Path

from rclpy.node import Node

from daidalos.common.names import camel_case, snake_case
from daidalos.common.suggestions import hint
from daidalos.nodes.composition import COMPONENTS
from daidalos.nodes.composition._together import run_together
from daidalos.nodes.extensions import find_component
from daidalos.nodes.runner import UserError, program_arguments, run_program


def main() -> int:
    """Run the nodes of the libraries that the command line names."""
    import rclpy.logging

    kinds: list[type[Node]] = []

    def find() -> None:
        paths = program_arguments()
        if not paths:
            raise UserError(f"name at least one library: {', '.join(_libraries())}")
        log = rclpy.logging.get_logger("dlopen_composition")
        for path in paths:
            name = _component(path)
            log.info(f"Load library {path}")
            log.info(f"Instantiate class composition::{name}")
            kinds.append(find_component("composition", f"composition::{name}"))

    return run_program(find) or run_together(kinds)


def _component(path: str) -> str:
    """Return the component that a library such as ``libtalker_component.so`` holds in ROS 2.

    The components here are Python classes: only the name of the library counts, the file need not exist.
    """
    found = re.fullmatch(r"lib(\w+)_component\.(?:so|dylib)|(\w+)_component\.dll", Path(path).name)
    name = camel_case(found.group(1) or found.group(2)) if found else ""
    if name not in COMPONENTS:
        raise UserError(f"there is no library '{Path(path).name}'{hint(Path(path).name, _libraries())}")
    return name


def _libraries() -> list[str]:
    return [f"lib{snake_case(name)}_component.so" for name in COMPONENTS]
