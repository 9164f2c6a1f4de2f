"""A simulated board of signals."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from daidalos.common.suggestions import hint
from daidalos.industry.rapid.runtime.errors import RapidError


class Board:
    """Signals by their names, upper and lower case being the same.

    Parameters
    ----------
    names
        Names of the signals; without any, each name that a program uses is a signal.
    values
        Values that signals begin with; all others are 0.
    """

    def __init__(self, names: Iterable[str] = (), values: dict[str, float] | None = None) -> None:
        self._aliases: dict[str, str] = {}
        self._known = {name.lower(): name for name in names}
        self._values = {self._key(name): float(value) for name, value in (values or {}).items()}
        self.listeners: list[Callable[[str, float], None]] = []

    def value(self, name: object) -> float:
        """Return the value of a signal."""
        return self._values.get(self._key(name), 0.0)

    def set(self, name: object, value: float) -> None:
        """Set a signal, and tell the listeners where it changes."""
        key = self._key(name)
        before = self._values.get(key, 0.0)
        self._values[key] = value
        if value != before:
            for listener in self.listeners:
                listener(key, value)

    def alias(self, name: str, key: str) -> None:
        """Connect data of a program to a signal."""
        self._aliases[key.lower()] = self._key(name)

    def remove_alias(self, key: str) -> None:
        """Disconnect data of a program from a signal."""
        self._aliases.pop(key.lower(), None)

    def origin(self, name: object) -> tuple[str, str]:
        """Return ``alias`` or ``board``, and the name of the signal."""
        key = self._key(name)
        return ("alias" if str(name).lower() in self._aliases else "board", self._known.get(key, str(name)))

    def values(self) -> dict[str, float]:
        """Return the values of all signals that have been used."""
        return {self._known.get(key, key): value for key, value in sorted(self._values.items())}

    def _key(self, name: object) -> str:
        key = self._aliases.get(str(name).lower(), str(name).lower())
        if self._known and key not in self._known:
            raise RapidError(
                "ERR_NO_ALIASIO_DEF", f"there is no signal '{name}'{hint(str(name), self._known.values())}"
            )
        return key
