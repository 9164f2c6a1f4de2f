"""Commands and verbs by name: those built in, and those that packages add by entry points."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import Any

from daidalos.common.extensions import Extension, Kind, describe, listing, load
from daidalos.common.names import camel_case


def built_in(descriptions: Mapping[str, str], package: str, suffix: str) -> Iterable[Extension]:
    """Return built-in commands or verbs: ``send_goal`` is the class ``SendGoalVerb`` in the module ``send_goal``.

    Parameters
    ----------
    descriptions
        One line each, by name.
    package
        That of the modules.
    suffix
        The end of the classes' names, such as ``Verb``.
    """
    for name, description in descriptions.items():
        class_name = camel_case(name) + suffix
        yield Extension((name,), f"{package}.{name}:{class_name}", description)


class Extensions(Mapping[str, Any]):
    """The commands or verbs of a kind, made when asked for.

    The installed packages are searched only for a name that is not built in, and to list them all.

    Parameters
    ----------
    kind
        Of extensions.
    """

    def __init__(self, kind: Kind[Any]) -> None:
        self.kind = kind
        self._built_in = {extension.name: extension for extension in kind.built_in()}

    def __contains__(self, name: object) -> bool:
        return name in self._built_in or name in self.all

    def __getitem__(self, name: str) -> Any:
        return load(self.kind, self.extension(name))()

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(self.all))

    def __len__(self) -> int:
        return len(self.all)

    @cached_property
    def all(self) -> dict[str, Extension]:
        """All extensions by name, those of entry points included."""
        return {extension.name: extension for extension in listing(self.kind)}

    def extension(self, name: str) -> Extension:
        """Return an extension that is not imported."""
        return self._built_in.get(name) or self.all[name]

    def describe(self, name: str) -> str:
        """Return an extension's description: one line without the full stop."""
        return describe(self.extension(name))
