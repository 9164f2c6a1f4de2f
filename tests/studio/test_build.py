"""Building the page: when it is due, with what, and that nothing is lost when it cannot be done."""

import json
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from daidalos.studio import build as module
from daidalos.studio.build import STAMP, build, is_fresh, needs_node, source_hash

SOURCES = Path(module.__file__).parents[2]
LOCK = {
    "packages": {
        "": {"name": "page"},
        "node_modules/vite": {"version": "8.0.0"},
        "node_modules/vitest": {"version": "4.0.0", "dev": True},
        "node_modules/only-on-windows": {"version": "1.0.0", "optional": True},
    }
}


@pytest.fixture
def web(tmp_path: Path) -> Path:
    web = tmp_path / "web"
    (web / "src").mkdir(parents=True)
    (web / "src" / "main.ts").write_text("let a = 1;\n")
    (web / "package.json").write_text("{}")
    (web / "package-lock.json").write_text(json.dumps(LOCK))
    return web


@pytest.fixture
def static(tmp_path: Path) -> Path:
    return tmp_path / "static"


@pytest.fixture
def no_node(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path / "nothing"))
    monkeypatch.setattr(module, "_node_of_wheel", lambda: None)
    monkeypatch.delenv(module.SKIP, raising=False)


class FakeNode:
    """Programs called node and npm that note how they were called and do as they are told."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.calls_file = folder / "calls"
        folder.mkdir()

    def install(self, version: str = "v22.13.1", vite: str = "echo '<html>' > $out/index.html") -> None:
        self._program("node", f'if [ "$1" = --version ]; then echo {version}; exit; fi\n{_OUT}{vite}')
        self._program("npm", "mkdir -p node_modules && cp package-lock.json node_modules/.package-lock.json")

    @property
    def calls(self) -> list[str]:
        return self.calls_file.read_text().splitlines() if self.calls_file.exists() else []

    def _program(self, name: str, body: str) -> None:
        path = self.folder / name
        note = f'[ "$1" = --version ] || echo "{name} $1" >> {self.calls_file}\n'
        path.write_text(f"#!/bin/sh\n{note}{body}\n")
        path.chmod(path.stat().st_mode | stat.S_IXUSR)


_OUT = 'for each; do out="$each"; done; mkdir -p "$out"\n'


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch, no_node: None, tmp_path: Path) -> FakeNode:
    if sys.platform == "win32":
        pytest.skip("the stand-ins are shell scripts")
    fake = FakeNode(tmp_path / "bin")
    monkeypatch.setenv("PATH", os.pathsep.join([str(fake.folder), "/usr/bin", "/bin"]))
    fake.install()
    return fake


def test_the_hash_knows_contents_and_names_but_not_line_ends_tests_and_libraries(web: Path) -> None:
    first = source_hash(web)
    (web / "node_modules").mkdir()
    (web / "node_modules" / "x.js").write_text("x")
    (web / "src" / "main.test.ts").write_text("test")
    (web / "src" / "main.ts").write_bytes(b"let a = 1;\r\n")
    assert source_hash(web) == first
    (web / "src" / "main.ts").write_text("let a = 2;\n")
    second = source_hash(web)
    assert second != first
    (web / "src" / "main.ts").rename(web / "src" / "other.ts")
    assert source_hash(web) not in (first, second)


def test_builds_once_and_again_when_sources_change(web: Path, static: Path, node: FakeNode) -> None:
    words: list[str] = []
    assert not is_fresh(web, static)
    assert build(words.append, web, static)
    assert is_fresh(web, static)
    assert (static / STAMP).read_text().strip() == source_hash(web)
    assert (static / "index.html.gz").is_file()
    assert [call.split()[0] for call in node.calls] == ["npm", "node"]
    assert build(words.append, web, static)
    assert len(node.calls) == 2
    (web / "src" / "main.ts").write_text("changed")
    assert not is_fresh(web, static)
    assert build(words.append, web, static)
    assert [call.split()[0] for call in node.calls] == ["npm", "node", "node"]
    assert not [word for word in words if "warning" in word]


def test_libraries_are_fetched_again_when_the_lock_changes(web: Path, static: Path, node: FakeNode) -> None:
    build(lambda _: None, web, static)
    lock = {"packages": {**LOCK["packages"], "node_modules/vite": {"version": "9.0.0"}}}
    (web / "package-lock.json").write_text(json.dumps(lock))
    build(lambda _: None, web, static)
    assert [call.split()[0] for call in node.calls] == ["npm", "node", "npm", "node"]


def test_a_failed_build_keeps_the_last_one_and_warns(web: Path, static: Path, node: FakeNode) -> None:
    build(lambda _: None, web, static)
    before = (static / "index.html").read_text()
    (web / "src" / "main.ts").write_text("broken")
    node.install(vite="echo 'main.ts:1 broken'; exit 3")
    words: list[str] = []
    assert not build(words.append, web, static)
    assert (static / "index.html").read_text() == before
    assert "warning" in words[-1]
    assert "main.ts:1 broken" in words[-1]
    assert "kept" in words[-1]
    assert not list(static.parent.glob(".static-*"))


def test_a_build_that_writes_no_page_is_none(web: Path, static: Path, node: FakeNode) -> None:
    node.install(vite="true")
    words: list[str] = []
    assert not build(words.append, web, static)
    assert not static.exists()
    assert "plain page" in words[-1]


def test_without_node_nothing_is_built_and_nothing_raised(web: Path, static: Path, no_node: None) -> None:
    words: list[str] = []
    assert not build(words.append, web, static)
    assert "no Node.js" in words[-1]


@pytest.mark.parametrize(
    ("version", "good"),
    [
        ("v20.19.0", True),
        ("v20.18.3", False),
        ("v18.20.1", False),
        ("v21.7.0", False),
        ("v22.11.0", False),
        ("v22.12.0", True),
        ("v24.1.0", True),
        ("nonsense", False),
    ],
)
def test_asks_for_a_node_where_there_is_no_usable_one(
    web: Path, static: Path, node: FakeNode, monkeypatch: pytest.MonkeyPatch, version: str, good: bool
) -> None:
    monkeypatch.setattr(module.platform, "machine", lambda: "x86_64")
    node.install(version)
    assert needs_node(web, static) is not good


def test_asks_for_no_node_where_none_would_help(
    web: Path, static: Path, no_node: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module.platform, "machine", lambda: "x86_64")
    assert needs_node(web, static)
    monkeypatch.setenv(module.SKIP, "1")
    assert not needs_node(web, static)
    monkeypatch.delenv(module.SKIP)
    monkeypatch.setattr(module.platform, "machine", lambda: "riscv64")
    assert not needs_node(web, static)
    monkeypatch.setattr(module.platform, "machine", lambda: "x86_64")
    static.mkdir()
    (static / "index.html").write_text("")
    (static / STAMP).write_text(source_hash(web))
    assert not needs_node(web, static)


def test_node_without_npm_is_no_node(web: Path, static: Path, node: FakeNode, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module.platform, "machine", lambda: "x86_64")
    (node.folder / "npm").unlink()
    monkeypatch.setenv("PATH", str(node.folder))
    assert needs_node(web, static)


def test_an_installed_package_without_sources_is_fresh(tmp_path: Path, static: Path) -> None:
    assert not is_fresh(tmp_path / "none", static)
    static.mkdir()
    (static / "index.html").write_text("")
    assert is_fresh(tmp_path / "none", static)


def test_the_committed_lock_names_no_registry() -> None:
    text = (module.WEB / "package-lock.json").read_text()
    assert '"resolved"' not in text
    assert "registry" not in text
    for name, entry in json.loads(text)["packages"].items():
        assert not name or "integrity" in entry, name


def test_runs_where_only_the_standard_library_is() -> None:
    """As the hook does."""
    program = f"import sys; sys.path.insert(0, {str(SOURCES)!r}); from daidalos.studio import build; build.is_fresh()"
    done = subprocess.run([sys.executable, "-I", "-S", "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_an_interface_without_definition_is_named_and_stops_nothing(web: Path, static: Path, node: FakeNode) -> None:
    (web / "src" / "main.ts").write_text('import type { LaserScam } from "./generated/sensor_msgs";\n')
    words: list[str] = []
    assert not build(words.append, web, static)
    assert "main.ts: there is no interface LaserScam in the package sensor_msgs" in words[-1]
