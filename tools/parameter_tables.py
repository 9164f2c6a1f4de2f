"""The reference manual's tables of parameters, from their declarations.

MkDocs calls `on_page_markdown` when it builds the manual; run as a program, this prints the page.
"""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from daidalos.common.parameters import Parameters, group_kinds, table

ROOT = Path(__file__).resolve().parent.parent / "src"
PAGE = "parameters.md"
MARKER = "<!-- tables of parameters -->"


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Return a page's Markdown, with the tables where the marker is."""
    return markdown.replace(MARKER, tables()) if page.file.src_uri == PAGE else markdown


def tables() -> str:
    """Return a section for each class of parameters, grouped by layer."""
    lines: list[str] = []
    layer = ""
    for kind in parameter_classes():
        here = kind.__module__.split(".")[1]
        if here != layer:
            layer = here
            lines.append(f"## {layer.capitalize()}\n")
        summary, _, details = (kind.__doc__ or "").strip().partition("\n")
        text = "\n".join(line.strip() for line in details.strip().splitlines())
        lines += [f"### {_title(kind)}\n", f"{summary}\n", *([f"{text}\n"] if text else []), table(kind)]
    return "\n".join(lines)


def parameter_classes() -> list[type[Parameters]]:
    """Return all classes of parameters that are not groups of another one, by module and name."""
    for module in _modules():
        import_module(module)
    found = [kind for kind in _subclasses(Parameters) if kind.__module__.startswith("daidalos.")]
    inner = {part for kind in found for part in group_kinds(kind)}
    return sorted((kind for kind in found if kind not in inner), key=lambda kind: (kind.__module__, kind.__name__))


def _modules() -> Iterator[str]:
    for path in sorted((ROOT / "daidalos").rglob("*.py")):
        if "from daidalos.common.parameters import" in path.read_text(encoding="utf-8"):
            yield ".".join(path.relative_to(ROOT).with_suffix("").parts)


def _subclasses(kind: type[Parameters]) -> Iterator[type[Parameters]]:
    for one in kind.__subclasses__():
        yield one
        yield from _subclasses(one)


def _title(kind: type[Parameters]) -> str:
    """Return the names in ROS of what has the parameters: of plugins, or a node's package and executable or class."""
    module = import_module(kind.__module__)
    for owner in vars(module).values():
        if isinstance(owner, type) and kind in (getattr(owner, "parameters", None), getattr(owner, "Parameters", None)):
            names = getattr(owner, "names", ())
            if names:
                return ", ".join(f"`{name}`" for name in names)
    parts = kind.__module__.split(".")
    if parts[1] == "nodes" and len(parts) == 4:
        of_module = [
            one for one in vars(module).values() if isinstance(one, type) and one.__module__ == kind.__module__
        ]
        is_program = (
            not parts[3].startswith("_") and kind is [one for one in of_module if issubclass(one, Parameters)][-1]
        )
        return f"`{parts[2]}`: `{parts[3] if is_program else kind.__name__.removesuffix('Parameters')}`"
    return f"`{kind.__name__}`"


if __name__ == "__main__":
    print(tables())
