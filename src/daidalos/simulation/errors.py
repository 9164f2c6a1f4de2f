"""Errors of the simulator."""

from __future__ import annotations

from collections.abc import Iterable

from daidalos.common.errors import UserError
from daidalos.description.errors import DescriptionError
from daidalos.description.markup import Element


class SimulationError(UserError):
    """Content that cannot be simulated; the message gives the reason."""


class UnknownNameError(SimulationError):
    """Unknown model, link or joint; the message lists the known ones.

    Parameters
    ----------
    kind : str
        What is named: ``model``, ``link``, ``joint``.
    name : str
    known : iterable of str
    """

    def __init__(self, kind: str, name: str, known: Iterable[str]) -> None:
        self.kind = kind
        self.name = name
        self.known = tuple(known)
        super().__init__(f"there is no {kind} {name!r}; known are {', '.join(self.known) or 'none'}")


class AbsentPartError(DescriptionError):
    """Reference of a plugin to a part of its model that is absent or unsuitable; the plugin is left out, as in Gazebo.

    Parameters
    ----------
    message : str
    element : Element
        What names the part.
    """

    def __init__(self, message: str, element: Element) -> None:
        super().__init__(message, element.source, element.line, element.label)


class NameTakenError(SimulationError):
    """Duplicate model name.

    Parameters
    ----------
    name : str
    """

    def __init__(self, name: str) -> None:
        self.name = name
        super().__init__(f"a model {name!r} is in the simulation already")
