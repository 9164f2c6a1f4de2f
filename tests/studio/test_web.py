"""The front end's own checks, where a developer has its tools (`npm install` in studio/web)."""

import shutil
import subprocess
from pathlib import Path

import pytest

from daidalos.studio import typescript
from daidalos.studio.build import WEB

EXAMPLE = Path(__file__).parents[2] / "examples" / "extensions" / "studio_panel" / "battery_panel" / "battery.js"

pytestmark = pytest.mark.slow


@pytest.fixture
def node() -> str:
    found = shutil.which("node")
    if found is None:
        pytest.skip("no Node.js here")
    return found


@pytest.mark.parametrize(("tool", "arguments"), [("typescript/bin/tsc", ["--noEmit"]), ("vitest/vitest.mjs", ["run"])])
def test_the_front_end_passes(node: str, tool: str, arguments: list[str]) -> None:
    typescript.write()
    _run(node, tool, arguments)


def test_an_extension_is_checked_against_the_published_contract(node: str, tmp_path: Path) -> None:
    shutil.copy(EXAMPLE, tmp_path)
    (tmp_path / "daidalos-studio.d.ts").write_text(typescript.contract())
    (tmp_path / "wrong.js").write_text(
        '/** @type {import("./daidalos-studio").Panel} */\nexport default { title: 1, mount() {} };\n'
    )
    check = ["--noEmit", "--checkJs", "--strict", "--skipLibCheck", "--ignoreConfig", "--target", "es2022"]
    modules = ["--module", "esnext", "--moduleResolution", "bundler"]
    _run(node, "typescript/bin/tsc", [*check, *modules, str(tmp_path / EXAMPLE.name)])
    with pytest.raises(AssertionError, match="Type 'number' is not assignable to type 'string'"):
        _run(node, "typescript/bin/tsc", [*check, *modules, str(tmp_path / "wrong.js")])


def _run(node: str, tool: str, arguments: list[str]) -> None:
    path = WEB / "node_modules" / Path(tool)
    if not path.is_file():
        pytest.skip(f"{tool} is not installed: npm install in studio/web")
    done = subprocess.run([node, str(path), *arguments], cwd=WEB, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
