"""Errors of control."""

from __future__ import annotations

from collections.abc import Iterable

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint


class ControlError(UserError):
    """Invalid hardware or controller, with a message of one line for the user."""


class HardwareError(ControlError):
    """Failure or refusal of hardware; raised by hardware classes."""


class UnknownError(ControlError):
    """Unknown name; the message suggests known ones.

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
    """Transition that the state of a controller or component does not allow."""


class SwitchError(ControlError):
    """Controllers that cannot be switched as asked."""
