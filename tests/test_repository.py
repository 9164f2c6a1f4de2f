"""The rules that tools can check: format, lint, types, layers and how docstrings begin."""

import ast
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from places import REPOSITORY

SCRIPTS = Path(sys.executable).parent
TOOLS = {
    "format": ["ruff", "format", "--check"],
    "lint": ["ruff", "check", "--output-format=concise"],
    "types": ["mypy"],
    "layers": ["lint-imports"],
}


@pytest.mark.slow
@pytest.mark.timeout(300)
@pytest.mark.parametrize("name", TOOLS)
def test_a_tool_has_nothing_to_say(name: str) -> None:
    program, *arguments = TOOLS[name]
    done = subprocess.run([SCRIPTS / program, *arguments], cwd=REPOSITORY, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-5000:] + done.stderr[-2000:]


def test_layers_and_types_are_checked_in_every_package() -> None:
    settings = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["tool"]
    packages = {path.parent.name for path in (REPOSITORY / "src/ros").glob("*/__init__.py")}
    linter = settings["importlinter"]
    assert set(linter["root_packages"]) == {"daidalos", *packages}
    layered = {name.strip() for layer in linter["contracts"][0]["layers"] for name in layer.split("|")}
    assert packages <= layered
    assert set(settings["mypy"]["packages"]) == {"daidalos", *packages}


# Imperatives all, which the linter's rule D401 accepts, but none describes what a function does.
BANNED = {"Be", "Begin", "Have", "Let", "Note", "Say", "See", "Tell"}
SOURCES = REPOSITORY / "src"
_MAYBE_BANNED = re.compile(rf'"""\s*({"|".join(sorted(BANNED))})\b')


def test_docstrings_begin_with_a_verb_of_the_field() -> None:
    assert list(_banned_beginnings()) == []


def _banned_beginnings() -> Iterator[str]:
    for path in SOURCES.rglob("*.py"):
        place = path.relative_to(SOURCES).as_posix()
        if place.startswith(("generated/", "daidalos/share/", "daidalos/studio/web/")):
            continue
        text = path.read_text(encoding="utf-8")
        if not _MAYBE_BANNED.search(text):
            continue
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
                words = (ast.get_docstring(node) or "").split(maxsplit=1)
                if words and words[0].rstrip(",.:;") in BANNED:
                    yield f"{place}:{getattr(node, 'lineno', 1)}: {words[0]}"
