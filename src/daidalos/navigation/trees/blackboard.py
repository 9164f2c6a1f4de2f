"""Blackboard: named values shared by the nodes of a tree, with a scope for each subtree."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


class Blackboard:
    """Values by name.

    The blackboard of a subtree holds values of its own; names that the subtree remaps are those of the tree
    around it, and with `autoremap` all names are.

    Parameters
    ----------
    around : Blackboard, optional
        Blackboard of the tree around a subtree.
    remapped : mapping of str to str, optional
        Name inside to name outside.
    autoremap : bool
        Whether a name that is not remapped is the same outside.
    """

    def __init__(
        self,
        around: Blackboard | None = None,
        remapped: Mapping[str, str] | None = None,
        *,
        autoremap: bool = False,
    ) -> None:
        self._around = around
        self._remapped = dict(remapped or {})
        self._autoremap = autoremap
        self._values: dict[str, Any] = {}
        self._revisions: dict[str, int] = {}

    def get(self, name: str, default: Any = None) -> Any:
        """Return the value of a name, or the default."""
        board, own = self._owner(name)
        return board._values.get(own, default)

    def set(self, name: str, value: Any) -> None:
        """Write a value."""
        board, own = self._owner(name)
        board._values[own] = value
        board._revisions[own] = board._revisions.get(own, 0) + 1

    def revision(self, name: str) -> int:
        """Return how many times a name was written."""
        board, own = self._owner(name)
        return board._revisions.get(own, 0)

    def remove(self, name: str) -> None:
        """Remove a value, if there is one."""
        board, own = self._owner(name)
        board._values.pop(own, None)

    def __contains__(self, name: str) -> bool:
        board, own = self._owner(name)
        return own in board._values

    def _owner(self, name: str) -> tuple[Blackboard, str]:
        """Return the blackboard that owns a name, and the name there."""
        if self._around is None:
            return self, name
        if name in self._remapped:
            return self._around._owner(self._remapped[name])
        if self._autoremap:
            return self._around._owner(name)
        return self, name
