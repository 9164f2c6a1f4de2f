"""Compares a list of ROS 2's public names and signatures with what our packages have."""

import importlib
import inspect
import re
from collections.abc import Iterator


def faults(listing: str) -> Iterator[tuple[str, ...]]:
    """Yield what the list names and our package lacks."""
    module = None
    for line in listing.splitlines():
        if line.startswith("## "):
            try:
                module = importlib.import_module(line[3:])
            except ImportError:
                module = None
                yield (line[3:],)
        elif module is None:
            continue
        elif line.startswith("names: "):
            for name in line[7:].split(", "):
                if not hasattr(module, name):
                    yield module.__name__, name
        elif line.startswith("- class "):
            yield from class_faults(module, line)
        elif line.startswith("- "):
            yield from function_faults((module.__name__,), module, line[2:])


def class_faults(module: object, line: str) -> Iterator[tuple[str, ...]]:
    match = re.fullmatch(r"- class (\w+)\((.*?)\): (.*)", line)
    assert match, line
    place = (module.__name__, match[1])
    kind = getattr(module, match[1], None)
    if kind is None:
        yield place
        return
    ancestors = {one.__name__ for one in kind.__mro__}
    for base in filter(None, match[2].split(", ")):
        if base.rpartition(".")[2] not in ancestors:
            yield *place, base
    for member in filter(None, match[3].split("; ")):
        if "(" in member and not member.endswith("(property)"):
            yield from function_faults(place, kind, member)
        elif not hasattr(kind, member.split(" ")[0]):
            yield *place, member.split(" ")[0]


def function_faults(place: tuple[str, ...], owner: object, text: str) -> Iterator[tuple[str, ...]]:
    match = re.fullmatch(r"(\w+)\((.*)\)(?: -> .*)?", text)
    assert match, text
    function = getattr(owner, match[1], None)
    if function is None:
        yield *place, match[1]
        return
    if isinstance(function, property):
        return
    wanted = {name for name in parameters(match[2]) if name not in ("self", "cls", "*", "/")}
    if {"*args", "**kwargs"} <= wanted:
        return
    present = inspect.signature(function).parameters
    for name in sorted(wanted):
        if name.lstrip("*") not in present:
            yield *place, match[1], name


def parameters(text: str) -> Iterator[str]:
    """Yield the names of a signature's parameters: commas in brackets do not part them."""
    depth, start = 0, 0
    for position, char in enumerate(text + ","):
        depth += (char in "([{<") - (char in ")]}>")
        if char == "," and depth == 0:
            name = re.split("[:=]", text[start:position])[0].strip()
            if name:
                yield name
            start = position + 1
