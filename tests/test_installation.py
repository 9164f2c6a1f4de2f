"""What the plain installation weighs."""

import importlib.metadata
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from places import REPOSITORY

LIMIT_MB = 700.0
ENVIRONMENT_MB = 15.0
"""What pip takes in a new virtual environment; setuptools, which some have as well, is among what is required."""
BYTECODE_PER_SOURCE = 1.4
"""Bytes of bytecode, which pip compiles, for a byte of Python."""
LARGEST_SHOWN = 12


@pytest.mark.slow
def test_the_plain_installation_is_small() -> None:
    sizes = {name: _size_mb(_files_of(name)) for name in _required()}
    sizes["daidalos"] = _size_mb(_our_files())
    total = ENVIRONMENT_MB + sum(sizes.values())
    largest = sorted(sizes.items(), key=lambda item: -item[1])[:LARGEST_SHOWN]
    assert total < LIMIT_MB, f"{total:.0f} MB: " + ", ".join(f"{name} {size:.0f}" for name, size in largest)


def _required() -> set[str]:
    """Return the distributions that the project needs, those that they need included, without extras."""
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    found: set[str] = set()
    waiting: list[str] = project["dependencies"]
    while waiting:
        requirement = Requirement(waiting.pop())
        name = re.sub(r"[-_.]+", "-", requirement.name).lower()
        if name not in found and (requirement.marker is None or requirement.marker.evaluate({"extra": ""})):
            found.add(name)
            waiting += importlib.metadata.requires(name) or []
    return found


def _our_files() -> Iterator[Path]:
    web = REPOSITORY / "src" / "daidalos" / "studio" / "web"
    return (path for path in (REPOSITORY / "src").rglob("*") if web not in path.parents)


def _files_of(name: str) -> Iterator[Path]:
    return (Path(str(file.locate())) for file in importlib.metadata.files(name) or [])


def _size_mb(files: Iterator[Path]) -> float:
    sizes = [
        path.stat().st_size * (1.0 + BYTECODE_PER_SOURCE * (path.suffix == ".py"))
        for path in files
        if "__pycache__" not in path.parts and path.is_file()
    ]
    return sum(sizes) / 1e6
