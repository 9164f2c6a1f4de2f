"""`daidalos bench barn`: a Jackal crosses the worlds of the BARN benchmark, or random ones of their kind."""

from __future__ import annotations

import argparse
import json
import statistics
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.testing.barn import BarnWorld
    from daidalos.testing.journal import Record

NAME = "barn"
_OTHERS = ("runs", "vary", "ray", "compare")
_RANDOM = range(100)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments that only BARN has."""
    group = parser.add_argument_group("barn", "A Jackal crosses fields of posts without a map, each from one side.")
    group.add_argument("--worlds", type=Path, metavar="FILE", help="worlds (.npz); without it, random ones")
    group.add_argument("--first", type=int, metavar="N", help="number of the first world (default: that of the file)")
    group.add_argument("--last", type=int, metavar="N", help="number of the last world (default: that of the file)")
    group.add_argument("--json", type=Path, metavar="FILE", help="write scores and results")
    group.add_argument("--params-file", type=Path, metavar="FILE", help="parameters of navigation of your own")


def check_absent(args: argparse.Namespace) -> None:
    """Raise an error where an argument of BARN is given to a scenario."""
    for name in ("worlds", "first", "last", "json", "params_file"):
        if getattr(args, name) is not None:
            raise UserError(f"--{name.replace('_', '-')} is for `daidalos bench {NAME}`, not for a scenario")


def main(args: argparse.Namespace) -> int:
    """Try the worlds; return 0 when the goal was reached in all of them."""
    from daidalos.cli.daidalos.fleet_progress import Progress
    from daidalos.testing.barn import BarnPlan, cross
    from daidalos.testing.fleet import run_here
    from daidalos.testing.journal import Journal

    for name in _OTHERS:
        if getattr(args, name):
            raise UserError(f"--{name} is for scenarios, not for `daidalos bench {NAME}`")
    if args.params_file is not None and not args.params_file.is_file():
        raise UserError(f"there is no parameter file '{args.params_file}'")
    worlds = _worlds(args)
    plan = BarnPlan(args.worlds, args.params_file, args.seed)
    folder = args.results or Path(f"bench-{NAME}")
    with Journal(folder, plan) as journal:
        present = [journal.records[world.number] for world in worlds if world.number in journal.records]
        progress = Progress(len(worlds), present)
        missing = [world for world in worlds if world.number not in journal.records]
        for record in run_here(missing, lambda process, world: cross(process, world, plan, folder), args.processes):
            journal.add(record)
            progress.add(record)
        progress.finish()
        records = [journal.records[world.number] for world in worlds]
    summary = summarize(records)
    for record in records:
        if not record.passed:
            print(f"world {record.number}: {record.message.splitlines()[0]} ({folder / record.folder / 'failure.png'})")
    print(
        f"reached {summary['reached']} of {summary['worlds']}, touched something in {summary['contacts']}; "
        f"mean time {summary['mean_time_s']:.2f} s"
    )
    print(f"score {summary['score']:.4f} of 0.25, with clip(T, 2 OT, 8 OT) {summary['strict_score']:.4f} of 0.5")
    if args.json is not None:
        _write_json(args.json, {**summary, "results": [_row(record) for record in records]})
    return 0 if summary["reached"] == summary["worlds"] else 1


def _worlds(args: argparse.Namespace) -> list[BarnWorld]:
    """Return the worlds that are asked for.

    Raises
    ------
    UserError
        When there are none.
    """
    from daidalos.testing.barn import random_world, read_worlds

    known = dict.fromkeys(_RANDOM) if args.worlds is None else read_worlds(args.worlds)
    first = min(known, default=0) if args.first is None else args.first
    last = max(known, default=0) if args.last is None else args.last
    if first < 0 or last < first:
        raise UserError(f"expected numbers of worlds with --first not above --last, got {first} and {last}")
    if args.worlds is None:
        return [random_world(number) for number in range(first, last + 1)]
    missing = [number for number in range(first, last + 1) if number not in known]
    if missing:
        raise UserError(f"{args.worlds}: there is no world {missing[0]}; it has {min(known)} to {max(known)}")
    return [world for number, world in sorted(known.items()) if world is not None and first <= number <= last]


def summarize(records: Sequence[Record]) -> dict[str, Any]:
    """Return the scores of some worlds."""
    reached = [record for record in records if record.passed]
    return {
        "worlds": len(records),
        "reached": len(reached),
        "contacts": sum("touched" in record.message for record in records),
        "success_rate": len(reached) / len(records),
        "score": statistics.fmean(record.metrics["score"] for record in records),
        "strict_score": statistics.fmean(record.metrics["strict_score"] for record in records),
        "mean_time_s": statistics.fmean(record.metrics["time_s"] for record in reached) if reached else 0.0,
    }


def _row(record: Record) -> dict[str, Any]:
    return {
        "world": record.number,
        "seed": record.seed,
        "success": record.passed,
        "message": record.message,
        "real_time_s": record.real_s,
        **record.metrics,
    }


def _write_json(path: Path, content: dict[str, Any]) -> None:
    """Write a file as a whole, or not at all."""
    written = path.with_name(f"{path.name}.part")
    try:
        written.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")
        written.replace(path)
    except OSError as error:
        raise UserError(f"{path}: {error.strerror or error}") from None
