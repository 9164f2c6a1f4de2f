"""Check docstrings against PEP 257 with pydocstyle."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from ament_lint.linters import python_files, report, run

_IGNORED = "D100,D101,D102,D103,D104,D105,D106,D107,D203,D212,D404"


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command, and return the exit status."""
    parser = argparse.ArgumentParser(description="Check docstrings against PEP 257 with pydocstyle.")
    parser.add_argument("paths", nargs="*", default=["."], help="files, and folders that are searched for them")
    parser.add_argument("--add-ignore", metavar="codes", default="", help="further codes to ignore, with commas")
    args = parser.parse_args(sys.argv[1:] if argv is None else argv)
    ignored = ",".join(filter(None, [_IGNORED, args.add_ignore]))
    files = python_files(args.paths)
    lines = run("pydocstyle", [f"--ignore={ignored}"], files)
    # Each fault has two lines: where it is, and what it is.
    errors = [
        f"{where.strip().removesuffix(':')}: {what.strip()}"
        for where, what in zip(lines[::2], lines[1::2], strict=False)
    ]
    return report(files, errors)


if __name__ == "__main__":
    sys.exit(main())
