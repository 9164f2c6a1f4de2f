"""Check code against PEP 8 with flake8."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from ament_lint.linters import python_files, report, run

_LINE_LENGTH = 99
_IGNORED = "B902,C816,D100,D101,D102,D103,D104,D105,D106,D107,D203,D212,D404,I202,W503"


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command, and return the exit status."""
    return main_with_errors(argv)[0]


def main_with_errors(argv: Sequence[str] | None = None) -> tuple[int, list[str]]:
    """Run the command, and return the exit status and what was found, as ``file:line:column: code text``."""
    parser = argparse.ArgumentParser(description="Check code against PEP 8 with flake8.")
    parser.add_argument("paths", nargs="*", default=["."], help="files, and folders that are searched for them")
    parser.add_argument("--config", metavar="path", help="the configuration of flake8")
    parser.add_argument("--linelength", type=int, default=_LINE_LENGTH, help="the longest line (%(default)s)")
    args = parser.parse_args(sys.argv[1:] if argv is None else argv)
    options = [f"--max-line-length={args.linelength}", f"--extend-ignore={_IGNORED}"]
    files = python_files(args.paths)
    errors = run("flake8", [f"--config={args.config}"] if args.config else options, files)
    return report(files, errors), errors


if __name__ == "__main__":
    sys.exit(main())
