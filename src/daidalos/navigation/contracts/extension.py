"""What every extension of navigation is made with, and its base class."""

from __future__ import annotations

from abc import ABC
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ClassVar, TypeVar

from daidalos.common.arrays import Array
from daidalos.common.errors import Location
from daidalos.common.extensions import Kind, find
from daidalos.navigation.costmap.footprint import Footprint

T = TypeVar("T")


def _ignore(line: str) -> None:
    """Ignore a line for the user."""


def _locate_nothing(frame: str) -> None:
    """Return None: no frame is known."""


@dataclass(frozen=True)
class NavigationContext:
    """Context of an extension beside its parameters.

    Attributes
    ----------
    name : str
        Name of the extension in parameter files, such as ``FollowPath``.
    footprint : Footprint
        Outline of the robot in its base frame [m].
    frequency : float
        How often it is called while it works [Hz].
    global_frame, base_frame : str
        Frames of the costmap and of the robot.
    track_unknown_space : bool
        Whether cells of the costmap that nothing was seen of are unknown, rather than free.
    seed : int
        Of random numbers.
    warn : callable
        Called with a line for the user.
    locate : callable
        Called with the name of a frame; returns its pose (x, y, yaw) in the global frame and the age [s] of that, or
        None where it is not known.
    maker : callable or None
        Makes another extension; see `make`.
    """

    name: str = ""
    footprint: Footprint = Footprint.circle(0.1)  # noqa: RUF009 (it does not change)
    frequency: float = 20.0
    global_frame: str = "map"
    base_frame: str = "base_link"
    track_unknown_space: bool = True
    seed: int = 0
    warn: Callable[[str], None] = _ignore
    locate: Callable[[str], tuple[Array, float] | None] = _locate_nothing
    maker: Callable[[Kind[Any], str, str, str], Any] | None = None

    def make(self, kind: Kind[T], name: str, parameter: str, below: str = "") -> T:
        """Create an extension that this one uses.

        Parameters
        ----------
        kind : Kind
        name : str
            As in parameter files.
        parameter : str
            The parameter of the extension that has the name.
        below : str
            Its parameters are called ``<name>.<below>.<parameter>``; they stand beside the own where empty.

        Raises
        ------
        ExtensionError
            There is none of that name.
        """
        if self.maker is not None:
            made: T = self.maker(kind, name, parameter, below)
            return made
        found: Any = find(kind, name, asked_by=Location(name=parameter))
        return found(None, replace(self, name=below or self.name))  # type: ignore[no-any-return]


_ALONE = NavigationContext()


class NavigationExtension(ABC):  # noqa: B024 (each contract has its own methods)
    """Base of all contracts.

    Parameters
    ----------
    parameters : object, optional
        An instance of the class attribute `Parameters`; the defaults where it is left out.
    context : NavigationContext, optional

    Attributes
    ----------
    names : tuple of str
        Class attribute: names of a built-in class in parameter files.
    Parameters : type or None
        Class attribute: the frozen dataclass of its parameters; None where it has none.
    """

    names: ClassVar[tuple[str, ...]] = ()
    Parameters: ClassVar[type | None] = None

    def __init__(self, parameters: Any = None, context: NavigationContext | None = None) -> None:
        kind: Any = type(self).Parameters
        self.parameters: Any = kind() if parameters is None and kind is not None else parameters
        self.context = context or _ALONE

    def reconfigure(self, parameters: Any) -> None:
        """Use other parameters from the next call on; those that are read-only are the same.

        Raises
        ------
        ParameterError
            They cannot be used.
        """
        self.parameters = parameters
