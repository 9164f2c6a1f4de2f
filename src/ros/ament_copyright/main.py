"""Check that source files say whose they are and under which licence."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence
from pathlib import Path

from ament_lint.linters import python_files, report

_NOTICE = re.compile(r"copyright\s+(\(c\)\s*)?(©\s*)?\d{4}", re.IGNORECASE)
_LICENSE = re.compile(r"licen[sc]e|spdx-license-identifier|redistribution|permission is hereby granted", re.IGNORECASE)


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command, and return the exit status."""
    parser = argparse.ArgumentParser(description="Check that source files have a notice of copyright and a licence.")
    parser.add_argument("paths", nargs="*", default=["."], help="files, and folders that are searched for them")
    args = parser.parse_args(sys.argv[1:] if argv is None else argv)
    files = python_files(args.paths)
    return report(files, [f"{path}: {fault}" for path in files if (fault := _fault(path))])


def _fault(path: Path) -> str:
    """Return what the comments at the beginning of a file lack; files without code need none."""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    if not any(line.strip() for line in lines):
        return ""
    head = []
    for line in lines:
        if not line.startswith("#") and line.strip():
            break
        head.append(line)
    text = "\n".join(head)
    if not _NOTICE.search(text):
        return "could not find copyright notice"
    return "" if _LICENSE.search(text) else "could not find license"


if __name__ == "__main__":
    sys.exit(main())
