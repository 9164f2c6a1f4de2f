"""`daidalos scenario`: scenarios of YAML files, and what is kept of a failure."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from daidalos.cli.daidalos.launching import run_launch
from daidalos.common.documents import parse_yaml
from daidalos.common.errors import UserError


class ScenarioVerb:
    """Run scenarios in lock-step, and look at those that failed."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos scenario`."""
        commands = parser.add_subparsers(title="commands", required=True, metavar="run | show")
        run = commands.add_parser("run", help="run scenarios; exit status 0 when all have passed")
        run.add_argument("files", nargs="+", type=Path, metavar="FILE", help="YAML file of a scenario")
        run.add_argument("--seed", type=int, metavar="N", help="in place of that of the files")
        run.add_argument(
            "--set", action="append", default=[], metavar="NAME=VALUE", help="value of a parameter of the scenarios"
        )
        run.add_argument(
            "--results", default="scenario-results", metavar="FOLDER", help="where bags and pictures of failures go"
        )
        run.set_defaults(_command=_run)
        show = commands.add_parser("show", help="play the bag of a failure in the studio, with its world and robots")
        show.add_argument("folder", type=Path, help="folder of the failure, or a bag")
        show.add_argument("--port", type=int, default=8765, metavar="N", help="of the studio (default: 8765)")
        show.add_argument("--no-browser", action="store_true", help="print the studio's address, open nothing")
        show.set_defaults(_command=_show)

    def main(self, *, args: argparse.Namespace) -> int:
        """Run the command."""
        status: int = args._command(args)
        return status


def _run(args: argparse.Namespace) -> int:
    """Run the scenarios one after the other; return 0 when all have passed."""
    from daidalos.testing.documents import read_scenario
    from daidalos.testing.processes import ScenarioProcess
    from daidalos.testing.single import run_once

    given = dict(_parse_setting(text) for text in args.set)
    documents = [read_scenario(path, given) for path in args.files]  # a fault is better told before anything runs
    failed = 0
    with ScenarioProcess() as process:
        for document in documents:
            seed = document.seed if args.seed is None else args.seed
            result = run_once(process, document, seed, given, Path(args.results))
            measured = "".join(f", {name} {value:g}" for name, value in result.metrics.items())
            outcome = "passed" if result.passed else "FAILED"
            print(f"{outcome}  {document.name}  (seed {seed}{measured})")
            if not result.passed:
                failed += 1
                print("\n".join(f"  {line}" for line in result.message.splitlines()))
                if result.folder is not None:
                    print(f"  look at it in the studio: daidalos scenario show {result.folder}")
    print(f"{len(documents) - failed} of {len(documents)} scenarios passed", file=sys.stderr)
    return 1 if failed else 0


def _parse_setting(text: str) -> tuple[str, Any]:
    name, separator, value = text.partition("=")
    if not separator or not name:
        raise UserError(f"expected NAME=VALUE, got '{text}'")
    return name, parse_yaml(value)


def _show(args: argparse.Namespace) -> int:
    """Play a bag again and again beside the studio, with the world and the robots of the failure."""
    from launch.actions import ExecuteProcess
    from launch_ros.actions import Node

    from daidalos.bags.reader import BagReader
    from daidalos.testing.kept_world import FILE_NAME

    bag = args.folder / "bag" if (args.folder / "bag").is_dir() else args.folder
    if not bag.exists():
        raise UserError(f"there is no bag at '{bag}'")
    for picture in sorted(args.folder.glob("*.png")) if args.folder.is_dir() else ():
        print(f"picture: {picture}")
    play = ["-m", "daidalos.cli.ros2", "bag", "play", str(bag), "--loop", "--disable-keyboard-controls"]
    with BagReader(bag) as reader:
        if "/clock" not in reader.topics:  # else there would be two clocks
            play.append("--clock")
    beside = [play]
    if (args.folder / FILE_NAME).is_file():
        beside.append(["-m", "daidalos.testing.replay", str(args.folder)])
    return run_launch(
        Node(
            package="foxglove_bridge",
            executable="foxglove_bridge",
            parameters=[{"port": args.port, "open_browser": not args.no_browser}],
            output="screen",
        ),
        *(ExecuteProcess(cmd=[sys.executable, *words], output="screen") for words in beside),
    )
