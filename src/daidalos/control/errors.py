"""Errors of control."""

from __future__ import annotations

from collections.abc import Iterable

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint


class ControlError(UserError):
    """Invalid hardware or controller, with a message of one line for the user."""


class HardwareError(ControlError):
    """Hardware refuses or fails; raise it from a hardware class of your own."""


class UnknownError(ControlError):
    """A name that is not there; says which are.

    Parameters
    ----------
    what : str
        Such as ``controller``.
    name : str
    known : iterable of str
    """

    def __init__(self, what: str, name: str, known: Iterable[str]) -> None:
        self.name = name
        self.known = tuple(known)
        super().__init__(f"there is no {what} '{name}'{hint(name, self.known)}")


class StateError(ControlError):
    """A transition that the state of a controller or component does not allow."""


class SwitchError(ControlError):
    """Controllers that cannot be switched as asked."""
