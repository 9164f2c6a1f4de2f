"""`urdf_to_graphviz`: draws a robot's tree as SVG and for Graphviz."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from daidalos.description import urdf
from daidalos.description.errors import DescriptionError
from daidalos.description.graph import to_dot, to_svg
from daidalos.nodes.packages import package_share


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="urdf_to_graphviz", description="Draw the tree of a robot.")
    parser.add_argument("file", type=Path, help="a URDF or xacro file")
    parser.add_argument("output", nargs="?", help="name of the files without ending; the robot's name by default")
    arguments = parser.parse_args()
    try:
        robot = urdf.load(arguments.file, resolve=package_share)
        name = arguments.output or robot.name
        for ending, text in ((".gv", to_dot(robot)), (".svg", to_svg(robot))):
            Path(name + ending).write_text(text, encoding="utf-8")
            print(f"Created file {name}{ending}")
    except DescriptionError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"error: cannot write '{error.filename}': {error.strerror}", file=sys.stderr)
        return 2
    return 0
