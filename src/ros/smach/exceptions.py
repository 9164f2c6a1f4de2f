"""Errors of state machines."""

from __future__ import annotations

from smach.log import logerr


class SmachError(Exception):
    """Error that is also logged, since containers may catch it.

    Parameters
    ----------
    message
        What is wrong.
    """

    def __init__(self, message: str) -> None:
        logerr(f"{type(self).__name__}: {message}")
        super().__init__(message)


class InvalidTransitionError(SmachError):
    """Error of an outcome or a transition that does not exist."""


class InvalidStateError(SmachError):
    """Error of a state that does not exist, exists already or is defined in a wrong way."""


class InvalidConstructionError(SmachError):
    """Error of a container that is not open for construction."""


class InvalidUserCodeError(SmachError):
    """Error in the code of a state or a callback."""
