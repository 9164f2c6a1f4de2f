"""Every declared parameter: read by some code, described, and in the manual's tables."""

import ast
import inspect
import math
import re
from dataclasses import fields
from functools import cache
from pathlib import Path

import pytest

from daidalos.common.parameters import Parameters, group_kinds, leaves
from tools.parameter_tables import parameter_classes, tables

SOURCE = Path(__file__).parents[2] / "src" / "daidalos"
CLASSES = parameter_classes()


class Reads(ast.NodeVisitor):
    """Names that a file reads: attributes, and what it may pass to `getattr`; not those in declarations and checks."""

    def __init__(self, path: Path) -> None:
        text = path.read_text(encoding="utf-8")
        self.names: set[str] = set()
        self.patterns: list[str] = []
        self._has_getattr = "getattr(" in text
        self.visit(ast.parse(text))

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        declares = any(isinstance(base, ast.Name) and base.id.endswith("Parameters") for base in node.bases)
        for one in node.body:
            if not (declares and isinstance(one, ast.FunctionDef) and one.name == "check"):
                self.visit(one)

    def visit_Call(self, node: ast.Call) -> None:
        called = node.func.id if isinstance(node.func, ast.Name) else ""
        if called == "per_name":
            self.names.update(ast.literal_eval(one.value) for one in node.keywords if one.arg == "by")
        elif called not in ("parameter", "ParameterError"):
            self.generic_visit(node)

    def visit_Attribute(self, node: ast.Attribute) -> None:
        if isinstance(node.ctx, ast.Load):
            self.names.add(node.attr)
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        if self._has_getattr and isinstance(node.value, str):
            self.names.add(node.value)

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        parts = [str(one.value) if isinstance(one, ast.Constant) else None for one in node.values]
        if self._has_getattr and sum(len(part) for part in parts if part) >= 5:
            self.patterns.append("".join(re.escape(part) if part else r"\w+" for part in parts))
        self.generic_visit(node)


@cache
def reads_of(package: str) -> tuple[Reads, ...]:
    """Return what the files of a package read, and those of the nodes."""
    folders = {SOURCE / package, SOURCE / "nodes"}
    return tuple(Reads(path) for folder in sorted(folders) for path in folder.rglob("*.py"))


def is_read(kind: type[Parameters], name: str) -> bool:
    packages = {one.__module__.split(".")[1] for one in kind.__mro__ if name in inspect.get_annotations(one)}
    files = [one for package in sorted(packages) for one in reads_of(package)]
    return any(name in one.names or any(re.fullmatch(form, name) for form in one.patterns) for one in files)


@pytest.mark.slow
def test_every_parameter_is_read() -> None:
    everything = {one for kind in CLASSES for one in (kind, *group_kinds(kind))}
    unread = sorted(
        f"{kind.__name__}.{one.name}"
        for kind in everything
        for one in fields(kind)  # type: ignore[arg-type]
        if not is_read(kind, one.name)
    )
    assert not unread, f"declared and never read: {', '.join(unread)}"


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)
def test_every_parameter_is_described(kind: type[Parameters]) -> None:
    for leaf in leaves(kind):
        described = leaf.constraints.description
        # Courses show the output of `ros2 param describe` for turtlesim, with ROS 2's own descriptions.
        assert described.endswith(".") or kind.__module__.startswith("daidalos.nodes.turtlesim"), (leaf.name, described)
        assert described[0].isupper(), (leaf.name, described)
        assert leaf.is_array == isinstance(leaf.default, tuple), leaf.name
        if leaf.type is float and not leaf.is_array and math.isfinite(leaf.default):
            assert isinstance(leaf.default, float), leaf.name


def test_the_manual_has_a_table_of_every_class() -> None:
    text = tables()
    assert text.count("| Parameter | Type |") == len(CLASSES) > 40
    assert "### `diff_drive_controller/DiffDriveController`" in text
    assert "| `wheel_separation` | float | `0.0` | m | above 0 | Distance between left and right wheels. |" in text
