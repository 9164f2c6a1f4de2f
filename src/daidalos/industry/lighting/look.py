"""What a light shows: brightness, colour, gobo, zoom and strobe, as DMX values and back."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from daidalos.common.errors import UserError
from daidalos.industry.lighting.fixture import (
    ADDITIVE,
    CLOSED,
    COLOR,
    DIMMER,
    EXTRA,
    GOBO,
    OPEN,
    PAN,
    RANDOM_STROBE,
    STROBE,
    SUBTRACTIVE,
    TILT,
    ZOOM,
    Channel,
    Color,
    Fixture,
    FixtureError,
    ValueRange,
)  # fmt: skip
from daidalos.industry.lighting.kinematics import Angles

WHITE: Color = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class Look:
    """What a light shows.

    Attributes
    ----------
    dimmer : float
        Share of the full brightness.
    color : str or Color
        Name of a colour of the wheel, or red, green and blue from 0 to 1.
    gobo : str
        Name of a gobo; empty for none.
    zoom : float or None
        Opening angle of the beam [rad]; None leaves it.
    strobe : float
        Frequency [Hz]; 0 for a steady light.
    """

    dimmer: float = 1.0
    color: str | Color = WHITE
    gobo: str = ""
    zoom: float | None = None
    strobe: float = 0.0


@dataclass(frozen=True)
class Appearance:
    """What is seen of a light that gets DMX values, as `appearance` returns it."""

    angles: Angles
    dimmer: float
    color: Color
    gobo: str
    beam_angle: float
    strobe: float


def parse_color(text: str) -> str | Color:
    """Return ``#rrggbb`` as red, green and blue from 0 to 1, and any other text as the name of a colour.

    Raises
    ------
    UserError
        When the text begins with # and is no colour.
    """
    if not text.startswith("#"):
        return text
    try:
        red, green, blue = bytes.fromhex(text[1:])
    except ValueError:
        raise UserError(f"'{text}' is no colour; write #rrggbb or a name of the colour wheel") from None
    return red / 255, green / 255, blue / 255


def write_look(fixture: Fixture, look: Look, data: bytearray, start: int = 0) -> None:
    """Write a look into the fixture's channels.

    Functions that the fixture lacks are left out as long as the look is an ordinary one: a fixture without strobe
    refuses a strobe, one without a dimmer shows dimmed colours where it mixes them.

    Raises
    ------
    FixtureError
        When the fixture cannot show it.
    """
    if not 0.0 <= look.dimmer <= 1.0:
        raise FixtureError(f"the dimmer must be from 0 to 1, got {look.dimmer:g}")
    has_dimmer = _write_share(fixture, DIMMER, look.dimmer, data, start)
    _write_color(fixture, look.color, 1.0 if has_dimmer else look.dimmer, data, start)
    _write_shutter(fixture, look, data, start)
    if look.gobo:
        _write_middle(fixture.named(GOBO, look.gobo), data, start)
    if look.zoom is not None and not _write_share(fixture, ZOOM, look.zoom, data, start):
        raise FixtureError(f"{fixture.name} has no zoom")


def write_angles(fixture: Fixture, angles: Angles, data: bytearray, start: int = 0) -> None:
    """Write pan and tilt into the fixture's channels, coarse and fine, rounded to the nearest step."""
    for function, angle in ((PAN, angles.pan), (TILT, angles.tilt)):
        axis = fixture.axis(function)
        if axis is not None:
            channel, meaning = axis
            channel.write(meaning.value_of(angle), data, start)


def read_angles(fixture: Fixture, data: bytes | bytearray, start: int = 0) -> Angles:
    """Return the pan and tilt that stand in the fixture's channels; 0 for an axis that it lacks."""
    values = []
    for function in (PAN, TILT):
        axis = fixture.axis(function)
        values.append(axis[1].meaning_of(axis[0].read(data, start)) if axis is not None else 0.0)
    return Angles(*values)


def appearance(fixture: Fixture, data: bytes | bytearray, start: int = 0) -> Appearance:
    """Return what is seen of a fixture that gets DMX values."""
    shares: dict[str, float] = {}
    color, gobo, strobe, shut = WHITE, "", 0.0, 1.0
    beam = fixture.beam_angle
    for channel in fixture.channels:
        value = channel.read(data, start)
        found = channel.range_at(value)
        if found is None:
            continue
        meaning = found.meaning_of(value)
        if found.function in (DIMMER, *ADDITIVE, *SUBTRACTIVE, *EXTRA):
            shares[found.function] = meaning
        elif found.function == COLOR and found.colors:
            color = _product(color, _mean(found.colors))
        elif found.function == GOBO:
            gobo = found.name
        elif found.function == ZOOM:
            beam = meaning
        elif found.function == CLOSED:
            shut = 0.0
        elif found.function in (STROBE, RANDOM_STROBE):
            strobe = meaning
    mixed = _product(color, _mixed(shares))
    dimmer = shut * shares.get(DIMMER, 1.0)
    return Appearance(read_angles(fixture, data, start), dimmer, mixed, gobo, beam, strobe)


def _write_share(fixture: Fixture, function: str, meaning: float, data: bytearray, start: int) -> bool:
    """Write a meaning by the range that holds it, or is nearest; return whether the fixture has the function."""
    found = list(fixture.ranges([function]))
    if not found:
        return False
    channel, best = min(found, key=lambda pair: _distance(pair[1], meaning))
    channel.write(best.value_of(meaning), data, start)
    return True


def _write_color(fixture: Fixture, color: str | Color, share: float, data: bytearray, start: int) -> None:
    wheel = list(fixture.ranges([COLOR]))
    mixes = [
        names for names in (ADDITIVE, SUBTRACTIVE) if {one.function for _, one in fixture.ranges(names)} >= set(names)
    ]
    if isinstance(color, str):
        if not wheel and mixes:
            raise FixtureError(f"{fixture.name} has no colour wheel; write the colour as #rrggbb")
        _write_middle(fixture.named(COLOR, color), data, start)
    elif mixes:
        for names in mixes:
            levels = [share * one for one in color]
            for name, level in zip(names, levels if names is ADDITIVE else [1.0 - one for one in levels], strict=True):
                _write_share(fixture, name, level, data, start)
            if names is ADDITIVE:
                break
    elif wheel:
        whole = [pair for pair in wheel if len(pair[1].colors) == 1] or wheel
        _write_middle(min(whole, key=lambda pair: math.dist(_mean(pair[1].colors or (WHITE,)), color)), data, start)


def _write_shutter(fixture: Fixture, look: Look, data: bytearray, start: int) -> None:
    if look.strobe > 0.0:
        if not _write_share(fixture, STROBE, look.strobe, data, start):
            raise FixtureError(f"{fixture.name} has no strobe")
        return
    wanted = CLOSED if look.dimmer == 0.0 else OPEN
    found = next(fixture.ranges([wanted]), None)
    if found is not None:
        _write_middle(found, data, start)


def _write_middle(found: tuple[Channel, ValueRange], data: bytearray, start: int) -> None:
    channel, meaning = found
    channel.write(meaning.middle, data, start)


def _distance(one: ValueRange, meaning: float) -> float:
    return 0.0 if one.holds(meaning) else min(abs(one.start - meaning), abs(one.end - meaning))


def _mixed(shares: dict[str, float]) -> Color:
    """Return the colour of the shares of all emitters or filters."""
    color = WHITE
    if any(name in shares for name in ADDITIVE):
        white = shares.get("white", 0.0)
        color = _color(min(shares.get(name, 0.0) + white, 1.0) for name in ADDITIVE)
    return _product(color, _color(1.0 - shares.get(name, 0.0) for name in SUBTRACTIVE))


def _mean(colors: tuple[Color, ...]) -> Color:
    return _color(sum(parts) / len(colors) for parts in zip(*colors, strict=True))


def _product(one: Color, other: Color) -> Color:
    return _color(a * b for a, b in zip(one, other, strict=True))


def _color(parts: Iterable[float]) -> Color:
    red, green, blue = parts
    return red, green, blue
