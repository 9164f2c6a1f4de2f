"""Extensions of `ros2` by name: those built in, and those that packages add by entry points."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint


class Extensions(Mapping[str, Any]):
    """Extensions by name: those built in, then those of a group of entry points.

    Nothing is imported, nor are the installed packages searched, before it is needed.

    Parameters
    ----------
    group
        The group of entry points.
    built_in
        Descriptions by name.
    load
        Makes a built-in extension.
    """

    def __init__(self, group: str, built_in: Mapping[str, str], load: Callable[[str], Any]) -> None:
        self.group = group
        self.built_in = built_in
        self._load = load

    def __contains__(self, name: object) -> bool:
        return name in self.built_in or name in self.added

    def __getitem__(self, name: str) -> Any:
        if name in self.built_in:
            return self._load(name)
        return self.added[name].load()()

    def __iter__(self) -> Iterator[str]:
        return iter(sorted({*self.built_in, *self.added}))

    def __len__(self) -> int:
        return len({*self.built_in, *self.added})

    @cached_property
    def added(self) -> dict[str, EntryPoint]:
        """The entry points of the group that have no built-in name."""
        from importlib.metadata import entry_points

        return {point.name: point for point in entry_points(group=self.group) if point.name not in self.built_in}

    def describe(self, name: str) -> str:
        """Return an extension's description: one line without the full stop."""
        return self.built_in.get(name) or first_line(self.added[name].load())


def first_line(thing: object) -> str:
    """Return the first line of a docstring without its full stop."""
    text = (getattr(thing, "__doc__", None) or "").strip()
    return text.partition("\n")[0].removesuffix(".")
