"""`daidalos bench`: a scenario many times, with other seeds and parameters."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.testing.journal import Record

EPILOG = """Each run has a seed of its own, and draws what is varied from it; `daidalos scenario run FILE --seed N
--set NAME=VALUE` repeats one, bit for bit. What is done is kept: the same command goes on where it was ended, and more
runs may be asked for. The exit status is 0 when all runs have passed, 1 when not."""

_EVERY_S = 10.0


class BenchVerb:
    """Run a scenario many times, with other seeds and parameters."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos bench`."""
        parser.epilog = EPILOG
        parser.add_argument("scenario", type=Path, help="YAML file of a scenario")
        parser.add_argument("--runs", type=int, default=100, metavar="N", help="how many (default: 100)")
        parser.add_argument(
            "--vary",
            action="append",
            default=[],
            metavar="NAME=VALUES",
            help="draw a parameter from LOW..HIGH or from A,B,C; may be given several times",
        )
        parser.add_argument("--seed", type=int, default=0, metavar="N", help="of the first run (default: 0)")
        parser.add_argument("--processes", type=int, metavar="N", help="at the same time (default: one a processor)")
        parser.add_argument(
            "--ray", metavar="ADDRESS", help="run on a cluster of Ray: HOST:PORT, 'auto', or 'local' to start one here"
        )
        parser.add_argument("--results", type=Path, metavar="FOLDER", help="where they go (default: bench-SCENARIO)")
        parser.add_argument("--compare", type=Path, metavar="FOLDER", help="results of another version")

    def main(self, *, args: argparse.Namespace) -> int:
        """Run them; return 0 when all have passed."""
        from daidalos.testing.fleet import run_fleet
        from daidalos.testing.journal import EXTRA, Journal, read_records
        from daidalos.testing.plan import Plan, Variation
        from daidalos.testing.report import comparison, summary, write_report

        if args.runs < 1:
            raise UserError(f"--runs should be 1 or more, got {args.runs}")
        if not args.scenario.is_file():
            raise UserError(f"there is no scenario '{args.scenario}'")
        plan = Plan(args.scenario, args.runs, args.seed, tuple(Variation.parse(text) for text in args.vary))
        folder = args.results or Path(f"bench-{args.scenario.name.partition('.')[0]}")
        other = read_records(args.compare) if args.compare is not None else []
        with Journal(folder, plan) as journal:
            progress = _Progress(args.runs, list(journal.records.values()))
            run_fleet(plan, journal, args.processes, progress.add, args.ray)
            progress.finish()
            records = [record for number, record in sorted(journal.records.items()) if number < args.runs]
            table = journal.write_parquet()
        write_report(folder / "report.html", str(args.scenario), records, folder, other)
        print(summary(records))
        for name, first, second, p in comparison(records, other) if other else ():
            print(f"{name}: {first}, the other version {second}, p = {p:.3g}")
        print(f"report: {folder / 'report.html'}")
        print(f"table: {table}" if table is not None else f"table: not written, it needs Parquet: {EXTRA}")
        return 0 if all(record.passed for record in records) else 1


class _Progress:
    """Progress on standard error: a line that changes on a terminal, else one every ten seconds."""

    def __init__(self, count: int, done: list[Record]) -> None:
        self._count = count
        self._done = len([record for record in done if record.number < count])
        self._failed = sum(not record.passed for record in done)
        self._before = self._done
        self._begun = self._said = time.monotonic()
        if self._before:
            sys.stderr.write(f"{self._before} of {count} runs are there already\n")

    def add(self, record: Record) -> None:
        """Count a result."""
        self._done += 1
        self._failed += not record.passed
        now = time.monotonic()
        if sys.stderr.isatty() or now - self._said >= _EVERY_S:
            self._said = now
            end = "\r" if sys.stderr.isatty() else "\n"
            sys.stderr.write(f"{self._line(now)}{end}")
            sys.stderr.flush()

    def finish(self) -> None:
        """Write the last line."""
        sys.stderr.write(f"{self._line(time.monotonic())}\n")

    def _line(self, now: float) -> str:
        rate = (self._done - self._before) / max(now - self._begun, 1e-9)
        left = (self._count - self._done) / rate if rate > 0.0 else 0.0
        minutes, seconds = divmod(round(left), 60)
        return (
            f"{self._done} of {self._count} runs, {self._failed} failed, {rate:.2g} runs/s, "
            f"{minutes}:{seconds:02d} min left"
        )
