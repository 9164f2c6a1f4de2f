"""The page on security names tests that are there."""

import ast
import re

import pytest

from places import REPOSITORY

_TEST = re.compile(r"`(tests/[\w/]+\.py)(?:::(\w+))?`")


@pytest.mark.slow
def test_every_threat_names_a_test() -> None:
    page = (REPOSITORY / "docs" / "security.md").read_text(encoding="utf-8")
    tables = re.findall(r"\| test \|\n\|[-|]+\n((?:\|.*\n)+)", page)
    rows = [row for table in tables for row in table.splitlines()]
    assert len(rows) > 20
    for row in rows:
        named = _TEST.findall(row)
        assert named, row
        for file, function in named:
            tree = ast.parse((REPOSITORY / file).read_text(encoding="utf-8"))
            names = {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)}
            assert not function or function in names, f"{file}::{function}"
