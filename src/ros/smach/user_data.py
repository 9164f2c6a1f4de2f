"""Data that states share: variables of a container, and the part of them that a state may see."""

from __future__ import annotations

import copy
import threading
from collections.abc import Collection, Iterable, Mapping
from typing import Any

from smach.exceptions import InvalidUserCodeError
from smach.log import logerr


class UserData:
    """Variables of a container, as attributes and as items; safe to use from several threads."""

    def __init__(self) -> None:
        self._data: dict[str, Any] = {}
        self._lock = threading.RLock()

    def update(self, other_userdata: UserData) -> None:
        """Take over the variables of others."""
        with self._lock:
            self._data.update(other_userdata._data)

    def extract(self, keys: Iterable[str], remapping: Mapping[str, str]) -> UserData:
        """Return copies of some variables.

        Parameters
        ----------
        keys
            Their names here.
        remapping
            Their names here by their names in the result, where the two differ.
        """
        names = {here: there for there, here in remapping.items()}
        if len(names) != len(remapping):
            logerr(f"SMACH userdata remapping is not one-to-one: {dict(remapping)}")
        extracted = UserData()
        for key in keys:
            extracted[names.get(key, key)] = copy.copy(self[key])
        return extracted

    def merge(self, ud: UserData, keys: Iterable[str], remapping: Mapping[str, str]) -> None:
        """Take over copies of some variables of others.

        Parameters
        ----------
        ud
            The others.
        keys
            Their names there.
        remapping
            Their names here by their names there, where the two differ.
        """
        for key in keys:
            self[remapping.get(key, key)] = copy.copy(ud[key])

    def keys(self) -> list[str]:
        """Return the names of the variables."""
        return list(self._data)

    def __contains__(self, key: object) -> bool:
        return key in self._data

    def __getitem__(self, key: str) -> Any:
        with self._lock:
            if key not in self._data:
                logerr(f"Userdata key '{key}' not available. Available keys are: {list(self._data)}")
                raise KeyError(key)
            return self._data[key]

    def __setitem__(self, key: str, item: Any) -> None:
        with self._lock:
            self._data[key] = item

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return self[name]

    def __setattr__(self, name: str, value: Any) -> None:
        if name.startswith("_"):
            object.__setattr__(self, name, value)
        else:
            self[name] = value

    def __getstate__(self) -> dict[str, Any]:
        return self._data

    def __setstate__(self, data: dict[str, Any]) -> None:
        self._data = data
        self._lock = threading.RLock()


class Remapper:
    """Variables of a container as one of its states sees them: the declared ones under the state's names.

    Parameters
    ----------
    ud
        The container's variables.
    input_keys, output_keys
        Those that the state may read and write; what it may only read, it gets as `Const`.
    remapping
        Names in the container by the state's names, where the two differ.
    """

    def __init__(
        self,
        ud: UserData,
        input_keys: Collection[str] = (),
        output_keys: Collection[str] = (),
        remapping: Mapping[str, str] | None = None,
    ) -> None:
        self._ud = ud
        self._input = input_keys
        self._output = output_keys
        self._map = remapping or {}

    def _remap(self, key: str) -> str:
        return self._map.get(key, key)

    def update(self, other_userdata: UserData) -> None:
        """Take over variables into the container."""
        self._ud.update(other_userdata)

    def keys(self) -> list[str]:
        """Return the names, in the container, of the variables that may be read."""
        return [self._remap(key) for key in self._input if self._remap(key) in self._ud]

    def __contains__(self, key: object) -> bool:
        return key in self._input and self._remap(str(key)) in self._ud

    def __getitem__(self, key: str) -> Any:
        if key not in self._input:
            raise InvalidUserCodeError(
                f"Reading from SMACH userdata key '{key}' but the only keys that were declared as input to this state "
                f"were: {list(self._input)}. This key needs to be declaread as input to this state."
            )
        value = self._ud[self._remap(key)]
        return value if key in self._output else get_const(value)

    def __setitem__(self, key: str, item: Any) -> None:
        if key not in self._output:
            logerr(
                f"Writing to SMACH userdata key '{key}' but the only keys that were declared as output from this state "
                f"were: {list(self._output)}."
            )
            return
        self._ud[self._remap(key)] = item

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return self[name]

    def __setattr__(self, name: str, value: Any) -> None:
        if name.startswith("_"):
            object.__setattr__(self, name, value)
        else:
            self[name] = value


def get_const(obj: Any) -> Any:
    """Return an object whose attributes cannot be set: itself if it has none of its own, else as `Const`."""
    return Const(obj) if hasattr(obj, "__dict__") else obj


class Const:
    """Object whose attributes and items can be read, but not set.

    Parameters
    ----------
    obj
        The object.
    """

    def __init__(self, obj: Any) -> None:
        object.__setattr__(self, "_obj", obj)

    def __getattr__(self, name: str) -> Any:
        return get_const(getattr(self._obj, name))

    def __getitem__(self, name: Any) -> Any:
        return get_const(self._obj[name])

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        """Call the object."""
        return self._obj(*args, **kwargs)

    def __setattr__(self, name: str, value: Any) -> None:
        raise TypeError(f"'{name}' is read-only: declare the key as output of the state to set it")

    def __delattr__(self, name: str) -> None:
        raise TypeError(f"'{name}' is read-only: declare the key as output of the state to delete it")
