"""What assistance devices have in common: the skills `point` and `show`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from daidalos.common import parameters
from daidalos.common.errors import UserError
from daidalos.common.pose3 import Vector

POINT, SHOW = "point", "show"


class DeviceError(UserError):
    """Error of a device that cannot do what is asked; the message names the reason."""


@dataclass(frozen=True)
class Content:
    """What a device shows.

    Attributes
    ----------
    color : str
        ``#rrggbb`` or a name; the device's own where empty.
    text : str
        Where the device can write.
    """

    color: str = ""
    text: str = ""


class Device(ABC):
    """Assistance device, which is made with its parameters and the folder that relative paths begin at.

    Attributes
    ----------
    names : tuple of str
        Class attribute: what the file of a sequence calls its ``kind``, of built-in ones.
    Parameters : type
        Class attribute: what the file may set.
    skills : tuple of str
        Class attribute: `POINT` and `SHOW`, or one of them.
    url : str
        Page that has to fill the device's screen; empty without one.
    """

    names: ClassVar[tuple[str, ...]] = ()
    Parameters: ClassVar[type[parameters.Parameters]] = parameters.Parameters
    skills: ClassVar[tuple[str, ...]] = (POINT, SHOW)
    url = ""

    @abstractmethod
    def __init__(self, parameters: Any, folder: Path) -> None:
        """Open the device; raises a `UserError` or `OSError` where it cannot be."""

    def point(self, place: Vector, content: Content) -> None:
        """Point at a place of the cell [m].

        Raises
        ------
        DeviceError
            When the place is out of reach; the device then stays as it is.
        """
        raise DeviceError("it cannot point")

    @abstractmethod
    def show(self, content: Content) -> None:
        """Show a content where the device is.

        Raises
        ------
        DeviceError
            When it cannot be shown; the device then stays as it is.
        """

    @abstractmethod
    def clear(self) -> None:
        """Show nothing."""

    def close(self) -> None:
        """Show nothing and release what the device holds."""
        self.clear()
