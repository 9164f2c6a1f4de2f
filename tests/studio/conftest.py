"""What the studio's tests share."""

import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from .page_packages import Install


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Install:
    """Return what installs a distribution: its name, a group of entry points, and these by their names."""

    def work(name: str, group: str, points: Mapping[str, str]) -> None:
        info = tmp_path / f"{name}-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
        lines = [f"[{group}]", *(f"{point} = {value}" for point, value in points.items())]
        (info / "entry_points.txt").write_text("\n".join(lines))
        if str(tmp_path) not in sys.path:
            monkeypatch.syspath_prepend(tmp_path)

    return work
