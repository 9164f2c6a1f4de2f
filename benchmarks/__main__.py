"""Run benchmarks and print what they measured beside what they should reach: `python -m benchmarks [NAME ...]`.

Every module here has a `run()` that returns figures by name. Each runs in a process of its own, one after the other,
because what one of them loads or leaves behind would be part of the next one's figures.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from benchmarks.goals import Goal, goal_of

FOLDER = Path(__file__).parent
RESULTS = FOLDER / "results"
NO_BENCHMARKS = {"__main__", "__init__", "goals", "floors", "messages", "processes", "runs"}
ONE = "import json, sys; from benchmarks import {name} as b; print('\\n' + json.dumps(b.run()))"


def main() -> int:
    names = sorted(path.stem for path in FOLDER.glob("*.py") if path.stem not in NO_BENCHMARKS)
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(names)}; all where none is given")
    parser.add_argument("--json", type=Path, metavar="FILE", help="where to write the figures (default: results/)")
    arguments = parser.parse_args()
    unknown = set(arguments.names) - set(names)
    if unknown:
        parser.error(f"there is no benchmark {', '.join(sorted(unknown))}; there are: {', '.join(names)}")
    figures, failed = measure(arguments.names or names)
    show(figures)
    file = arguments.json or RESULTS / f"{time.strftime('%Y-%m-%dT%H-%M-%S')}.json"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps({"machine": machine(), "figures": figures, "failed": failed}, indent=1) + "\n")
    print(f"\nwritten to {file}")
    return 1 if failed else 0


def measure(names: list[str]) -> tuple[dict[str, Any], list[str]]:
    """Return all figures, and the benchmarks that ended with an error."""
    figures: dict[str, Any] = {}
    failed = []
    for number, name in enumerate(names, 1):
        print(f"[{number}/{len(names)}] {name}", file=sys.stderr, flush=True)
        done = subprocess.run(
            [sys.executable, "-c", ONE.format(name=name)], cwd=FOLDER.parent, stdout=subprocess.PIPE, text=True
        )
        if done.returncode:
            failed.append(name)
        else:
            figures |= json.loads(done.stdout.splitlines()[-1])
    return figures, failed


def show(figures: dict[str, Any]) -> None:
    """Print a table of the figures with their goals."""
    from rich.console import Console
    from rich.table import Table

    table = Table("figure", "measured", "goal", "", "theirs", "times bare")
    for column in (1, 2, 4, 5):
        table.columns[column].justify = "right"
    for name, value in figures.items():
        goal = goal_of(name)
        table.add_row(name, _text(value), *_comparison(goal, value), _ratio(goal, value, figures))
    Console(width=max(110, Console().width)).print(table)


def _comparison(goal: Goal | None, value: Any) -> tuple[str, str, str]:
    if goal is None:
        return "", "", ""
    verdict = ("[green]yes" if goal.is_met(value) else "[red]no") if isinstance(value, int | float) else ""
    return str(goal), verdict, goal.theirs


def _ratio(goal: Goal | None, value: Any, figures: dict[str, Any]) -> str:
    """Return how many times a figure is what its floor is, measured beside it without any of ours."""
    floor = figures.get(goal.floor) if goal is not None else None
    return f"{value / floor:.2f}" if floor else ""


def _text(value: Any) -> str:
    return format(value, ".4g") if isinstance(value, float) else str(value)


def machine() -> dict[str, Any]:
    """Return where this was measured."""
    return {"system": platform.platform(), "python": platform.python_version(), "cores": os.cpu_count()}


if __name__ == "__main__":
    sys.exit(main())
