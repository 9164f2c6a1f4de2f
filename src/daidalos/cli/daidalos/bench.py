"""`daidalos bench`: a scenario many times, with other seeds and parameters, or the BARN benchmark."""

from __future__ import annotations

import argparse
from pathlib import Path

from daidalos.cli.daidalos import bench_barn
from daidalos.cli.daidalos.fleet_progress import Progress
from daidalos.common.errors import UserError

EPILOG = """Each run has a seed of its own, and draws what is varied from it; `daidalos scenario run FILE --seed N
--set NAME=VALUE` repeats one, bit for bit. What is done is kept: the same command goes on where it was ended, and more
runs may be asked for. The exit status is 0 when all runs have passed, 1 when not."""

RUNS = 100


class BenchVerb:
    """Run a scenario many times, with other seeds and parameters."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos bench`."""
        parser.epilog = EPILOG
        parser.add_argument("scenario", type=Path, help=f"YAML file of a scenario, or '{bench_barn.NAME}'")
        parser.add_argument("--runs", type=int, metavar="N", help=f"how many (default: {RUNS})")
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
        bench_barn.add_arguments(parser)

    def main(self, *, args: argparse.Namespace) -> int:
        """Run them; return 0 when all have passed."""
        from daidalos.testing.fleet import run_fleet
        from daidalos.testing.journal import EXTRA, Journal, read_records
        from daidalos.testing.plan import Plan, Variation
        from daidalos.testing.report import comparison, summary, write_report

        if args.processes is not None and args.processes < 1:
            raise UserError(f"--processes should be 1 or more, got {args.processes}")
        if str(args.scenario) == bench_barn.NAME and not args.scenario.is_file():
            return bench_barn.main(args)
        bench_barn.check_absent(args)
        count = RUNS if args.runs is None else args.runs
        if count < 1:
            raise UserError(f"--runs should be 1 or more, got {count}")
        if not args.scenario.is_file():
            raise UserError(f"there is no scenario '{args.scenario}'")
        plan = Plan(args.scenario, count, args.seed, tuple(Variation.parse(text) for text in args.vary))
        folder = args.results or Path(f"bench-{args.scenario.name.partition('.')[0]}")
        other = read_records(args.compare) if args.compare is not None else []
        with Journal(folder, plan) as journal:
            progress = Progress(count, [record for number, record in journal.records.items() if number < count])
            run_fleet(plan, journal, args.processes, progress.add, args.ray)
            progress.finish()
            records = [record for number, record in sorted(journal.records.items()) if number < count]
            table = journal.write_parquet()
        write_report(folder / "report.html", str(args.scenario), records, folder, other)
        print(summary(records))
        for name, first, second, p in comparison(records, other) if other else ():
            print(f"{name}: {first}, the other version {second}, p = {p:.3g}")
        print(f"report: {folder / 'report.html'}")
        print(f"table: {table}" if table is not None else f"table: not written, it needs Parquet: {EXTRA}")
        return 0 if all(record.passed for record in records) else 1
