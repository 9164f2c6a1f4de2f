"""The kinds of all layers: their built-in extensions and their contracts."""

import inspect
import pkgutil
from functools import partial
from importlib import import_module
from pathlib import Path

import pytest

from daidalos.common.extensions import classes_in, describe, listing, load

LAYERS = ("simulation", "control", "navigation", "industry.assistance", "industry.grinding", "nodes")
KINDS = {kind.name: kind for layer in LAYERS for kind in import_module(f"daidalos.{layer}.extensions").KINDS}


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_built_in_classes_fulfil_the_contract_and_are_documented(kind) -> None:
    found = listing(kind)
    assert found
    module, _, name = kind.contract.partition(":")
    contract = getattr(import_module(module), name)
    for extension in found:
        assert issubclass(load(kind, extension), contract)
        assert describe(extension)


@pytest.mark.parametrize(
    "kind", [kind for kind in KINDS.values() if isinstance(kind.built_in, partial)], ids=lambda kind: kind.name
)
def test_names_that_are_read_from_files_are_those_of_the_classes(kind) -> None:
    assert kind.built_in.func is classes_in
    named = {}
    for package in map(import_module, kind.built_in.args):
        for info in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
            module = import_module(info.name)
            for name, cls in inspect.getmembers(module, inspect.isclass):
                if cls.__module__ == module.__name__ and vars(cls).get("names"):
                    named[f"{module.__name__}:{name}"] = cls.names
    assert {one.target: one.names for one in kind.built_in()} == named


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_no_name_means_two_classes(kind) -> None:
    names = [name for extension in listing(kind) for name in extension.names]
    assert len(names) == len(set(names))


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_the_table_of_the_manual_names_the_kind_and_its_contract(kind) -> None:
    page = (Path(__file__).parents[2] / "docs" / "extending.md").read_text(encoding="utf-8")
    rows = [line for line in page.splitlines() if line.startswith("|") and f"`{kind.name}`" in line]
    assert len(rows) == 1
    assert f"`{kind.group}`" in rows[0]
    assert f"{kind.contract.partition(':')[2]}`" in rows[0]
