"""`generate_motion_primitives`: writes the motions of the State Lattice planner to a file."""

from __future__ import annotations

import argparse
import json
import sys
from datetime import date
from pathlib import Path

from daidalos.common.documents import DocumentError, parse_json, read_text
from daidalos.common.errors import Location, UserError
from daidalos.common.parameters import ParameterError, parameters_from
from daidalos.navigation.planners.lattice_generation import LatticeOptions, generate_lattice
from daidalos.navigation.planners.state_lattice import StateLattice, lattice_document
from daidalos.nodes.runner import program_arguments

_EDGE = 800
_COLORS = ("#3b6ea5", "#b5502f")


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(
        prog="generate_motion_primitives", description="Write the motions of the State Lattice planner to a file."
    )
    parser.add_argument("--config", type=Path, help="a JSON file with motion_model, turning_radius and others")
    parser.add_argument("--output", type=Path, default=Path("output.json"), help="the file (default: %(default)s)")
    parser.add_argument("--visualizations", type=Path, metavar="FOLDER", help="where to draw the motions, as SVG")
    arguments = parser.parse_args(program_arguments())
    try:
        options = _options(arguments.config) if arguments.config else LatticeOptions()
        lattice = generate_lattice(options)
        metadata = {
            "stopping_threshold": options.stopping_threshold,
            "trajectory_distinctness_ratio": options.trajectory_distinctness_ratio,
        }
        document = lattice_document(lattice, metadata, date.today().isoformat())
        arguments.output.write_text(json.dumps(document, indent=2) + "\n", encoding="utf-8")
        print(f"{len(lattice.primitives)} motions at {lattice.headings.size} headings are in {arguments.output}")
        if arguments.visualizations:
            arguments.visualizations.mkdir(parents=True, exist_ok=True)
            picture = arguments.visualizations / "all_trajectories.svg"
            picture.write_text(drawing(lattice), encoding="utf-8")
            print(f"They are drawn in {picture}")
    except UserError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"error: cannot write '{error.filename}': {error.strerror}", file=sys.stderr)
        return 2
    return 0


def _options(path: Path) -> LatticeOptions:
    """Return the options of a configuration file."""
    try:
        given = parse_json(read_text(path), str(path))
    except OSError as error:
        raise UserError(f"cannot be read: {error.strerror}", Location(str(path))) from None
    if not isinstance(given, dict):
        raise DocumentError('must be an object such as {"turning_radius": 0.5}', str(path))
    try:
        return parameters_from(LatticeOptions, given)
    except ParameterError as error:
        raise UserError(str(error), Location(str(path))) from None


def drawing(lattice: StateLattice) -> str:
    """Return the motions of all headings as an SVG document; the robot begins in the middle, x to the right."""
    farthest = max(float(abs(one.poses[:, :2]).max()) for one in lattice.primitives)
    scale = 0.48 * _EDGE / farthest
    lines = []
    for one in lattice.primitives:
        points = " ".join(f"{scale * x:.1f},{-scale * y:.1f}" for x, y, _ in [(0.0, 0.0, 0.0), *one.poses])
        lines.append(f'<polyline points="{points}" stroke="{_COLORS[one.start % 2]}"/>')
    half = _EDGE // 2
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{-half} {-half} {_EDGE} {_EDGE}">'
        f'<g fill="none" stroke-width="1.5">{"".join(lines)}</g></svg>\n'
    )
