"""Temporary files that last as long as the process."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from daidalos.common import temporary_files

MAKE = """
import os
from daidalos.common.temporary_files import delete_temporary_files, make_temporary_folder, write_temporary
file, folder = write_temporary("text", "one_", ".yaml"), make_temporary_folder("two_")
(folder / "inside").write_text(file.read_text())
print(file, folder, flush=True)
"""


@pytest.mark.parametrize("end", ["", "delete_temporary_files(); os._exit(0)", "raise KeyboardInterrupt"])
def test_a_process_leaves_nothing(tmp_path: Path, end: str) -> None:
    environment = os.environ | {"TMPDIR": str(tmp_path), "TEMP": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", MAKE + end], capture_output=True, text=True, env=environment)
    file, folder = map(Path, done.stdout.split())
    assert (file.parent, file.suffix, file.name[:4], folder.name[:4]) == (tmp_path, ".yaml", "one_", "two_")
    assert list(tmp_path.iterdir()) == []


def test_a_fork_does_not_delete_the_files_of_its_parent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(temporary_files, "_paths", set())
    monkeypatch.setattr(temporary_files, "_owner", 0)
    file = temporary_files.write_temporary("text", "kept_")
    with monkeypatch.context() as fork:
        fork.setattr(os, "getpid", lambda: -1)
        temporary_files.delete_temporary_files()
        assert file.exists()
        own = temporary_files.write_temporary("text", "own_")
        temporary_files.delete_temporary_files()
        assert (own.exists(), file.exists()) == (False, True)
    file.unlink()
