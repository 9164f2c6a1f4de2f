"""The front end's own checks, where a developer has its tools (`npm install` in studio/web)."""

import shutil
import subprocess
from pathlib import Path

import pytest

from daidalos.studio import typescript
from daidalos.studio.build import WEB

pytestmark = pytest.mark.slow


@pytest.fixture
def node() -> str:
    found = shutil.which("node")
    if found is None:
        pytest.skip("no Node.js here")
    return found


@pytest.mark.parametrize(("tool", "arguments"), [("typescript/bin/tsc", ["--noEmit"]), ("vitest/vitest.mjs", ["run"])])
def test_the_front_end_passes(node: str, tool: str, arguments: list[str]) -> None:
    path = WEB / "node_modules" / Path(tool)
    if not path.is_file():
        pytest.skip(f"{tool} is not installed: npm install in studio/web")
    typescript.write()
    done = subprocess.run([node, str(path), *arguments], cwd=WEB, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
