"""Contract of what serves operations of the protocol."""

from __future__ import annotations

import fnmatch
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from rosbridge_library.internal.exceptions import (
    InvalidArgumentException,
    MissingArgumentException,
    NotAllowedException,
)

if TYPE_CHECKING:
    from rosbridge_library.protocol import Protocol

Field = tuple[bool, str, type | tuple[type, ...]]
"""Whether a field is needed, its name, and what its value may be."""


class Capability:
    """Operations of one client, which it registers with the client's protocol.

    Parameters
    ----------
    protocol
        The client's protocol.
    """

    def __init__(self, protocol: Protocol) -> None:
        self.protocol = protocol

    def finish(self) -> None:
        """Close what the client opened: it has left."""

    def basic_type_check(self, msg: dict[str, Any], types_info: Iterable[Field]) -> None:
        """Raise a MissingArgumentException or InvalidArgumentException for fields that are not as expected."""
        for needed, name, kinds in types_info:
            if name not in msg:
                if needed:
                    raise MissingArgumentException(f"Expected a {name} field but none was found.")
            elif not isinstance(msg[name], kinds):
                expected = " or ".join(one.__name__ for one in (kinds if isinstance(kinds, tuple) else (kinds,)))
                raise InvalidArgumentException(f"Expected field {name} to be {expected}, got {msg[name]!r:.100}")

    def check_name(self, globs: Sequence[str] | None, name: str) -> None:
        """Raise a NotAllowedException where there are patterns and a name matches none of them."""
        if globs and not any(fnmatch.fnmatchcase(name, glob) for glob in globs):
            raise NotAllowedException(f"{name} matches none of the allowed patterns: {', '.join(globs)}")

    def check_room(self, held: int, what: str) -> None:
        """Raise a NotAllowedException where the client has as many of something as it may."""
        if held >= self.protocol.max_held:
            raise NotAllowedException(f"more than {self.protocol.max_held} {what}")


def split_id(name: str, given: Any) -> tuple[str, Any]:
    """Return a name without the id after ``#``, as in ``/topics#33``, and the id, of which the one given goes first."""
    name, _, inside = name.partition("#")
    return name, given if given is not None else inside or None
