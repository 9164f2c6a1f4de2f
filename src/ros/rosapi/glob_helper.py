"""Patterns of names that clients may see."""

from __future__ import annotations

import fnmatch
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from rclpy.node import Node


class Globs(NamedTuple):
    """Patterns of topics, services and parameters; none allows all."""

    topics: list[str]
    services: list[str]
    params: list[str]


def get_globs(node: Node) -> Globs:
    """Return the patterns of a node's parameters ``topics_glob``, ``services_glob`` and ``params_glob``."""
    return Globs(*(split_globs(node.get_parameter(f"{kind}_glob").value) for kind in Globs._fields))


def split_globs(text: str | None) -> list[str]:
    """Return the patterns of a text such as ``[/a, '/b/*']``."""
    inner = (text or "").strip().removeprefix("[").removesuffix("]")
    return [one for part in inner.split(",") if (one := part.strip().strip("'\""))]


def filter_globs(globs: Sequence[str] | None, full_list: Iterable[str]) -> list[str]:
    """Return the names that a pattern allows."""
    return [name for name in full_list if any_match(name, globs)]


def any_match(query: str, globs: Sequence[str] | None) -> bool:
    """Return whether a pattern allows a name; none allows all."""
    return not globs or any(fnmatch.fnmatchcase(str(query), glob) for glob in globs)
