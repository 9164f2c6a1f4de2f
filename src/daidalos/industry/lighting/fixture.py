"""Channels of a light fixture: which DMX values mean which angle, brightness, colour, gobo or strobe."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint

Color = tuple[float, float, float]
"""Red, green and blue from 0 to 1."""

PAN, TILT, SPEED, DIMMER, ZOOM, OTHER = "pan", "tilt", "speed", "dimmer", "zoom", "other"
OPEN, CLOSED, STROBE, RANDOM_STROBE = "open", "closed", "strobe", "random strobe"
COLOR, GOBO = "color", "gobo"
ADDITIVE = ("red", "green", "blue")
SUBTRACTIVE = ("cyan", "magenta", "yellow")
EXTRA = ("white", "amber", "uv", "lime", "indigo")
FUNCTIONS = (
    PAN, TILT, SPEED, DIMMER, ZOOM, OPEN, CLOSED, STROBE, RANDOM_STROBE, COLOR, GOBO, *ADDITIVE, *SUBTRACTIVE, *EXTRA,
    OTHER,
)  # fmt: skip
ANGLES = (PAN, TILT, ZOOM)
"""Functions whose values are angles [rad]; those of strobes are frequencies [Hz], all others shares from 0 to 1."""


class FixtureError(UserError, ValueError):
    """Error of a fixture file, or of a wish that a fixture cannot fulfil."""


@dataclass(frozen=True)
class ValueRange:
    """Range of DMX values with one meaning.

    Attributes
    ----------
    first, last : int
        In the channel's full resolution, both included.
    function : str
        One of `FUNCTIONS`.
    start, end : float
        What the first and the last value mean: angles [rad], frequencies [Hz] or shares.
    name : str
        Of a colour, a gobo or an effect.
    colors : tuple of Color
        Of a colour: two where the wheel stands between two slots.
    """

    first: int
    last: int
    function: str
    start: float = 0.0
    end: float = 1.0
    name: str = ""
    colors: tuple[Color, ...] = ()

    @property
    def middle(self) -> int:
        """Value in the middle of the range."""
        return (self.first + self.last) // 2

    def holds(self, meaning: float) -> bool:
        """Return whether some value means this."""
        return min(self.start, self.end) <= meaning <= max(self.start, self.end)

    def value_of(self, meaning: float) -> int:
        """Return the value that is nearest to a meaning; outside, the end of the range."""
        if self.start == self.end:
            return self.first
        share = (meaning - self.start) / (self.end - self.start)
        return self.first + round(min(max(share, 0.0), 1.0) * (self.last - self.first))

    def meaning_of(self, value: int) -> float:
        """Return what a value of this range means."""
        if self.first == self.last:
            return self.start
        return self.start + (self.end - self.start) * (value - self.first) / (self.last - self.first)


@dataclass(frozen=True)
class Channel:
    """Channel of a fixture with its fine channels.

    Attributes
    ----------
    name : str
    offsets : tuple of int
        Where its bytes stand, from 0, the coarse one first.
    default : int
        Value while nobody sets it.
    ranges : tuple of ValueRange
        In ascending order; values between them mean nothing.
    """

    name: str
    offsets: tuple[int, ...]
    default: int = 0
    ranges: tuple[ValueRange, ...] = ()

    @property
    def most(self) -> int:
        """Greatest value."""
        return (1 << 8 * len(self.offsets)) - 1

    def write(self, value: int, data: bytearray, start: int = 0) -> None:
        """Write a value, the most significant byte at the coarse channel."""
        for place, offset in enumerate(reversed(self.offsets)):
            data[start + offset] = value >> 8 * place & 0xFF

    def read(self, data: bytes | bytearray, start: int = 0) -> int:
        """Return the value that stands in the data."""
        value = 0
        for offset in self.offsets:
            value = value << 8 | data[start + offset]
        return value

    def range_at(self, value: int) -> ValueRange | None:
        """Return the range that holds a value."""
        return next((one for one in self.ranges if one.first <= value <= one.last), None)


@dataclass(frozen=True)
class Fixture:
    """Light fixture in one of its modes.

    Attributes
    ----------
    name, mode : str
    size : int
        Number of DMX channels.
    channels : tuple of Channel
    beam_angle : float
        Opening angle of the beam [rad].
    pan_speed, tilt_speed : float
        Greatest speeds [rad/s].
    acceleration : float
        Greatest acceleration of both axes [rad/s^2].
    source : str
        The file.
    """

    name: str
    mode: str
    size: int
    channels: tuple[Channel, ...]
    beam_angle: float = 0.035
    pan_speed: float = 4.0
    tilt_speed: float = 4.0
    acceleration: float = 20.0
    source: str = ""

    def ranges(self, functions: Iterable[str]) -> Iterator[tuple[Channel, ValueRange]]:
        """Yield all ranges with one of some functions, and their channels."""
        wanted = set(functions)
        for channel in self.channels:
            yield from ((channel, one) for one in channel.ranges if one.function in wanted)

    def axis(self, function: str) -> tuple[Channel, ValueRange] | None:
        """Return the channel and the range of pan or tilt; None where the fixture does not move so."""
        return next(self.ranges([function]), None)

    def named(self, function: str, name: str) -> tuple[Channel, ValueRange]:
        """Return the channel and the range of a colour or gobo.

        Raises
        ------
        FixtureError
            When there is none of that name.
        """
        found = {one.name.lower(): (channel, one) for channel, one in reversed(list(self.ranges([function])))}
        if name.lower() not in found:
            names = [one.name for _, one in self.ranges([function])]
            raise FixtureError(f"'{name}' is no {function} of {self.name}{hint(name, names)}")
        return found[name.lower()]

    @cached_property
    def defaults(self) -> bytes:
        """Return the bytes of all channels at their defaults."""
        data = bytearray(self.size)
        for channel in self.channels:
            channel.write(channel.default, data)
        return bytes(data)
