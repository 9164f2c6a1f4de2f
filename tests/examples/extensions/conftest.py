"""Packages of the examples, installed for one test."""

import os
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from nodes.stepped import compiled, stage
from places import REPOSITORY
from ros.graph import graph

__all__ = ["compiled", "graph", "stage"]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Return a function that puts an example's package and its entry points on the path, for other programs as well."""
    before = set(sys.modules)

    def put(name: str) -> None:
        folder = REPOSITORY / "examples" / "extensions" / name
        project = tomllib.loads((folder / "pyproject.toml").read_text())["project"]
        info = tmp_path / f"{project['name'].replace('-', '_')}-{project['version']}.dist-info"
        info.mkdir()
        metadata = f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
        (info / "METADATA").write_text(metadata)
        groups = project["entry-points"].items()
        lines = [
            line for group, points in groups for line in (f"[{group}]", *(f"{k} = {v}" for k, v in points.items()))
        ]
        (info / "entry_points.txt").write_text("\n".join(lines))
        for place in (folder, tmp_path):
            monkeypatch.syspath_prepend(place)
        paths = [str(folder), str(tmp_path), os.environ.get("PYTHONPATH", "")]
        monkeypatch.setenv("PYTHONPATH", os.pathsep.join(path for path in paths if path))

    yield put
    for module in set(sys.modules) - before:
        if str(REPOSITORY / "examples") in str(getattr(sys.modules[module], "__file__", "")):
            del sys.modules[module]


Install = Callable[[str], None]
