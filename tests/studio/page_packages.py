"""Packages that bring panels and displays, as if they were installed."""

from collections.abc import Callable, Mapping
from pathlib import Path

Install = Callable[[str, str, Mapping[str, str]], None]


def make_package(folder: Path, name: str, files: Mapping[str, str]) -> None:
    """Write an importable package with some files."""
    for path, text in {"__init__.py": "", **files}.items():
        (folder / name / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / name / path).write_text(text)
