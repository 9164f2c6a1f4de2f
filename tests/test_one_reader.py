"""YAML is read by `daidalos.common.documents` only, whose limits hold for every file."""

import ast
from collections.abc import Iterator
from pathlib import Path

from places import REPOSITORY

_READER = "daidalos/common/documents.py"
_ALLOWED = {"daidalos/studio/rviz_writing.py"}
"""Files that take the nodes of a text that was read within the limits before."""
_READING = {"load", "load_all", "safe_load", "safe_load_all", "full_load", "unsafe_load", "compose", "parse", "scan"}


def uses(path: Path) -> Iterator[str]:
    """Yield the lines that read YAML by PyYAML itself."""
    text = path.read_text(encoding="utf-8")
    if "yaml" not in text:
        return
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "yaml":
            if node.attr in _READING:
                yield f"{path}:{node.lineno}"
        elif isinstance(node, ast.ImportFrom) and node.module == "yaml":
            yield from (f"{path}:{node.lineno}" for alias in node.names if alias.name in _READING)


def test_nothing_else_reads_yaml() -> None:
    root = REPOSITORY / "src"
    files = [path for package in ("daidalos", "ros") for path in (root / package).rglob("*.py")]
    others = [path for path in files if path.relative_to(root).as_posix() not in {_READER, *_ALLOWED}]
    found = [line for path in others for line in uses(path)]
    assert found == []
    assert list(uses(root / _READER))
