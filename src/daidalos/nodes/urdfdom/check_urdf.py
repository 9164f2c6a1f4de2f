"""`check_urdf`: checks a robot description, and prints its tree."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from daidalos.description import urdf
from daidalos.description.errors import DescriptionError
from daidalos.description.report import tree_text
from daidalos.nodes.packages import package_share


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="check_urdf", description="Check a robot description and print its tree.")
    parser.add_argument("file", type=Path, help="a URDF or xacro file")
    arguments = parser.parse_args()
    try:
        robot = urdf.load(arguments.file, resolve=package_share)
    except DescriptionError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print(tree_text(robot), end="")
    return 0
