"""Interfaces shared by hardware and controllers: named values in arrays."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from daidalos.common.arrays import Array
from daidalos.control.errors import ControlError, UnknownError


class Interfaces:
    """Command or state interfaces of one owner, hardware or controller.

    Parameters
    ----------
    names : iterable of str
        Full names, such as ``elbow/position``.

    Attributes
    ----------
    names : tuple of n strings
    values : array (n,)
        NaN where nothing is known yet. It stays the same array, so that views on it stay valid.
    """

    def __init__(self, names: Iterable[str] = ()) -> None:
        self.names = tuple(names)
        self.index: Mapping[str, int] = {name: i for i, name in enumerate(self.names)}
        if len(self.index) < len(self.names):
            twice = next(name for name in self.names if self.names.count(name) > 1)
            raise ControlError(f"the interface '{twice}' is there twice")
        self.values = np.full(len(self.names), np.nan)

    def __contains__(self, name: object) -> bool:
        return name in self.index

    def __getitem__(self, name: str) -> float:
        return float(self.values[self._place(name)])

    def __setitem__(self, name: str, value: float) -> None:
        self.values[self._place(name)] = value

    def _place(self, name: str) -> int:
        try:
            return self.index[name]
        except KeyError:
            raise UnknownError("interface", name, self.names) from None


class LoanedInterfaces:
    """Interfaces of one or several owners in the order that a controller requests.

    Parameters
    ----------
    names : sequence of n strings
    owners : iterable of Interfaces

    Raises
    ------
    UnknownError
        When none of the owners has one of them.
    """

    def __init__(self, names: Sequence[str] = (), owners: Iterable[Interfaces] = ()) -> None:
        self.names = tuple(names)
        owners = tuple(owners)
        places: dict[int, tuple[Interfaces, list[int], list[int]]] = {}
        for row, name in enumerate(self.names):
            owner = next((one for one in owners if name in one), None)
            if owner is None:
                raise UnknownError("interface", name, [known for one in owners for known in one.names])
            _, rows, columns = places.setdefault(id(owner), (owner, [], []))
            rows.append(row)
            columns.append(owner.index[name])
        self._parts = [
            (owner.values, np.array(rows, dtype=np.intp), np.array(columns, dtype=np.intp))
            for owner, rows, columns in places.values()
        ]
        # Nearly always one owner has all of them.
        self._single = self._parts[0] if len(self._parts) == 1 else None

    def __len__(self) -> int:
        return len(self.names)

    def read(self) -> Array:
        """Return the values (n,), a copy."""
        if self._single is not None:
            values, _, columns = self._single
            return values[columns]
        result = np.empty(len(self.names))
        for values, rows, columns in self._parts:
            result[rows] = values[columns]
        return result

    def write(self, values: Array) -> None:
        """Set the values (n,)."""
        if self._single is not None:
            own, rows, columns = self._single
            own[columns] = values
            return
        values = np.asarray(values, dtype=np.float64)
        for own, rows, columns in self._parts:
            own[columns] = values[rows]


def interface_names(joints: Sequence[str], interfaces: Sequence[str]) -> tuple[str, ...]:
    """Return the names of interfaces: all joints of the first kind, then of the second."""
    return tuple(f"{joint}/{interface}" for interface in interfaces for joint in joints)
