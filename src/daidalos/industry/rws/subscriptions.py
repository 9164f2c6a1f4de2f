"""Subscriptions of Robot Web Services: groups of resources whose changes are sent over a web socket."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from daidalos.industry.rws.resources import Item, Malformed, Resources, Unknown

MAX_GROUPS, MAX_RESOURCES = 10, 1000


@dataclass
class Group:
    """Resources that one client follows, with their latest values."""

    number: int
    names: list[str]
    latest: dict[str, Item] = field(default_factory=dict)


class Subscriptions:
    """All groups of a controller."""

    def __init__(self, resources: Resources) -> None:
        self._resources = resources
        self._groups: dict[int, Group] = {}
        self._count = 0

    def add(self, form: Mapping[str, str]) -> tuple[Group, list[Item]]:
        """Return a new group of the resources that a form names, and their values.

        Raises
        ------
        Malformed, Unknown
            Where it names none, too many, or one that there is not.
        """
        numbers = form.get("resources", "").split("|") if "|" in form.get("resources", "") else None
        keys = numbers or sorted((key for key in form if key.isdigit()), key=int)
        names = [form[key] for key in keys if key in form]
        if not names:
            raise Malformed("no resources are named: resources=1&1=/rw/panel/ctrlstate&1-p=1")
        if len(names) > MAX_RESOURCES or len(self._groups) >= MAX_GROUPS:
            raise Malformed(f"at most {MAX_GROUPS} groups of {MAX_RESOURCES} resources are followed")
        group = Group(self._count + 1, names)
        items = self._changes(group)
        self._count += 1
        self._groups[group.number] = group
        return group, items

    def group(self, number: int) -> Group:
        """Return a group; raise `Unknown` where there is none of this number."""
        if number not in self._groups:
            raise Unknown(f"there is no subscription {number}")
        return self._groups[number]

    def remove(self, number: int) -> None:
        """Forget a group."""
        self.group(number)
        del self._groups[number]

    def changes(self, group: Group) -> list[Item]:
        """Return the resources of a group that have changed since the last call."""
        return self._changes(group)

    def _changes(self, group: Group) -> list[Item]:
        changed = []
        for name in group.names:
            path, _, detail = name.partition(";")
            found = self._resources.get(path)
            if len(found) != 1:
                raise Malformed(f"'{name}' cannot be followed")
            item = replace(found[0], kind=_event_kind(found[0], detail), path=name)
            if group.latest.get(name) != item:
                group.latest[name] = item
                changed.append(item)
        return changed


def _event_kind(item: Item, detail: str) -> str:
    """Return the class of an event."""
    if item.kind == "rap-execution":
        return f"rap-{detail or 'ctrlexecstate'}-ev"
    if item.kind == "rap-data":
        return "rap-value-ev"
    if item.kind == "ios-signal":
        return "ios-signalstate-ev"
    return f"{item.kind}-ev"
