"""Running a linter over the Python files of a package."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

_IGNORED = ("AMENT_IGNORE", "COLCON_IGNORE")


def python_files(paths: Sequence[str]) -> list[Path]:
    """Return the Python files among and below some paths, without folders that are to be ignored."""
    return sorted({file for path in paths or ["."] for file in _below(Path(path))})


def _below(path: Path) -> Iterator[Path]:
    if path.is_file():
        yield path
        return
    for root, folders, files in os.walk(path):
        if any(name in files for name in _IGNORED):
            folders.clear()
            continue
        folders[:] = [name for name in folders if name[0] not in "._"]
        yield from (Path(root) / name for name in files if name.endswith(".py"))


def run(tool: str, arguments: Sequence[str], files: Sequence[Path]) -> list[str]:
    """Return the lines that a linter prints about files.

    Without the linter, a test that asks for it is skipped, and a command ends with a message.
    """
    if importlib.util.find_spec(tool) is None:
        text = f'{tool} is not installed: pip install "daidalos[lint]"'
        if "PYTEST_CURRENT_TEST" not in os.environ:
            raise SystemExit(text)
        import pytest

        pytest.skip(text)
    if not files:
        return []
    done = subprocess.run(
        [sys.executable, "-m", tool, *arguments, *map(str, files)], capture_output=True, text=True, check=False
    )
    if done.stderr.strip():
        raise SystemExit(done.stderr.strip())
    return done.stdout.splitlines()


def report(files: Sequence[Path], errors: Sequence[str]) -> int:
    """Print what was found, and return the exit status."""
    end = f"{len(errors)} errors" if errors else "No problems found"
    sys.stdout.writelines(f"{line}\n" for line in (*errors, "", f"{len(files)} files checked", end))
    return 1 if errors else 0
