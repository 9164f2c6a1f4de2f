"""What assistance devices have in common: the skills `point` and `show`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

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
    """Assistance device.

    Attributes
    ----------
    skills : tuple of str
        Class attribute: `POINT` and `SHOW`, or one of them.
    """

    skills: ClassVar[tuple[str, ...]] = (POINT, SHOW)

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
