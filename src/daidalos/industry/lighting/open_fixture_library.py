"""Reader of fixtures of the Open Fixture Library (https://open-fixture-library.org), a format in JSON."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

from daidalos.common.suggestions import hint
from daidalos.industry.lighting.fixture import (
    ADDITIVE,
    CLOSED,
    COLOR,
    DIMMER,
    EXTRA,
    GOBO,
    OPEN,
    OTHER,
    PAN,
    RANDOM_STROBE,
    SPEED,
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

_WORDS = {
    "off": 0.0, "dark": 0.01, "bright": 1.0, "stop": 0.0, "slow": 0.01, "fast": 1.0, "slow reverse": -0.01,
    "fast reverse": -1.0, "closed": 0.0, "narrow": 0.01, "wide": 1.0, "low": 0.01, "high": 1.0,
    "slow CW": 0.01, "fast CW": 1.0, "slow CCW": -0.01, "fast CCW": -1.0,
}  # fmt: skip
_UNITS = {"deg": math.pi / 180, "Hz": 1.0, "bpm": 1 / 60, "%": 0.01, "": 1.0}
_ENTITY = re.compile(r"\s*(-?[0-9]+(?:\.[0-9]*)?)\s*(deg|Hz|bpm|%|)\s*")
_RESOLUTION = {"8bit": 1, "16bit": 2, "24bit": 3}
_AXES = {"Pan": PAN, "Tilt": TILT}
_FASTEST_STROBE = 20.0
"""Frequency [Hz] that stands for 100 % where a fixture names no frequency."""
_WIDEST_ZOOM = math.radians(60.0)


def fixture_from_json(content: Any, mode: str, source: str) -> Fixture:
    """Return one mode of a fixture of the Open Fixture Library.

    Angles of pan and tilt are counted from the middle of their range, as every head stands at DMX 50 %.

    Parameters
    ----------
    content : object
        What the JSON says.
    mode : str
        Name or short name of the mode; the first where empty.
    source : str
        The file's name, for errors.

    Raises
    ------
    FixtureError
        When it is not such a fixture, or has no such mode.
    """
    if not isinstance(content, dict) or not isinstance(content.get("modes"), list) or not content["modes"]:
        raise FixtureError(f"{source}: is no fixture of the Open Fixture Library: it has no list 'modes'")
    chosen = _mode(content["modes"], mode, source)
    available = _mapping(content.get("availableChannels", {}), "availableChannels", source)
    keys = chosen.get("channels")
    if not isinstance(keys, list) or not 1 <= len(keys) <= 512:
        raise FixtureError(f"{source}: a mode's 'channels' must be a list of 1 to 512 channels")
    coarse_of = {
        alias: key
        for key, channel in available.items()
        for alias in _mapping(channel, key, source).get("fineChannelAliases", [])
    }
    channels = tuple(
        _channel(key, available, keys, content, f"{source}: channel '{key}'")
        for key in keys
        if isinstance(key, str) and key not in coarse_of
    )
    physical = {**_physical(content), **_physical(chosen)}
    return Fixture(
        name=str(content.get("name", "fixture")),
        mode=str(chosen.get("name", "")),
        size=len(keys),
        channels=channels,
        beam_angle=_beam_angle(physical),
        source=source,
    )


def _mode(modes: list[Any], wanted: str, source: str) -> Mapping[str, Any]:
    found = [_mapping(one, "modes", source) for one in modes]
    if not wanted:
        return found[0]
    for one in found:
        if wanted in (one.get("name"), one.get("shortName")):
            return one
    raise FixtureError(f"{source}: '{wanted}' is no mode{hint(wanted, [str(one.get('name')) for one in found])}")


def _channel(
    key: str, available: Mapping[str, Any], keys: list[Any], content: Mapping[str, Any], place: str
) -> Channel:
    """Return a channel with those of its fine channels that the mode uses."""
    item = available.get(key)
    if item is None:  # a switching or matrix channel, whose function depends on others
        return Channel(key, (keys.index(key),))
    aliases = item.get("fineChannelAliases", [])
    fine = []
    for alias in aliases:
        if alias not in keys:
            break
        fine.append(keys.index(alias))
    width = 1 + len(fine)
    written = _RESOLUTION.get(item.get("dmxValueResolution", ""), 1 + len(aliases))
    items = item.get("capabilities") or [item.get("capability", {"type": "Generic"})]
    if not isinstance(items, list):
        raise FixtureError(f"{place}: 'capabilities' must be a list")
    ranges = tuple(_range(_mapping(one, "capability", place), key, width, written, content, place) for one in items)
    default = _scaled(_default(item.get("defaultValue", 0), written, place), width, written, 257)
    return Channel(key, (keys.index(key), *fine), default, ranges)


def _default(value: Any, written: int, place: str) -> int:
    if isinstance(value, str) and value.endswith("%"):
        return round(_entity(value, place) * ((1 << 8 * written) - 1))
    if type(value) is int and 0 <= value < 1 << 8 * written:
        return value
    raise FixtureError(f"{place}: 'defaultValue' must be a DMX value or a percentage, got {value!r}")


def _scaled(value: int, width: int, written: int, step: int) -> int:
    """Return a value in another number of bytes; upwards, each byte multiplies by 256 or, for values, repeats."""
    if width >= written:
        for _ in range(width - written):
            value = (value << 8) + (value & 0xFF if step == 257 else 0)
        return value
    return value >> 8 * (written - width)


def _range(
    one: Mapping[str, Any], key: str, width: int, written: int, content: Mapping[str, Any], place: str
) -> ValueRange:
    most = (1 << 8 * written) - 1
    bounds = one.get("dmxRange", [0, most])
    if not (isinstance(bounds, list) and len(bounds) == 2 and all(type(value) is int for value in bounds)):
        raise FixtureError(f"{place}: 'dmxRange' must be [first, last], got {bounds!r}")
    if not 0 <= bounds[0] <= bounds[1] <= most:
        raise FixtureError(f"{place}: 'dmxRange' must ascend within 0 and {most}, got {bounds!r}")
    first = _scaled(bounds[0], width, written, 256)
    last = (
        _scaled(bounds[1] + 1, width, written, 256) - 1 if width >= written else _scaled(bounds[1], width, written, 256)
    )
    function, start, end = _meaning(one, place)
    name, colors = _slot(one, key, content)
    if function == "slot":
        function = GOBO if name and not colors else COLOR if colors else OTHER
    return ValueRange(first, last, function, start, end, name, colors)


def _meaning(one: Mapping[str, Any], place: str) -> tuple[str, float, float]:
    """Return the function of a capability, and what its first and last values mean."""
    kind = one.get("type", "Generic")
    if kind in _AXES:
        start, end = _pair(one, "angle", (0.0, 0.0), place)
        middle = 0.5 * (start + end)
        return _AXES[kind], start - middle, end - middle
    if kind == "Intensity":
        return (DIMMER, *_pair(one, "brightness", (0.0, 1.0), place))
    if kind == "ColorIntensity":
        color = str(one.get("color", "")).lower()
        known = color in (*ADDITIVE, *SUBTRACTIVE, *EXTRA)
        return (color if known else OTHER, *_pair(one, "brightness", (0.0, 1.0), place))
    if kind == "ShutterStrobe":
        return _shutter(one, place)
    if kind == "Zoom":
        start, end = _pair(one, "angle", (0.0, 1.0), place)
        scale = 1.0 if "deg" in str(one.get("angleStart", one.get("angle", ""))) else _WIDEST_ZOOM
        return ZOOM, scale * start, scale * end
    if kind == "PanTiltSpeed":
        return (SPEED, *_pair(one, "speed", (0.0, 1.0), place))
    if kind in ("WheelSlot", "ColorPreset"):
        return "slot", 0.0, 1.0
    return OTHER, 0.0, 1.0


def _shutter(one: Mapping[str, Any], place: str) -> tuple[str, float, float]:
    effect = one.get("shutterEffect")
    if effect in ("Open", "Closed"):
        is_open = float(effect == "Open")
        return (OPEN if is_open else CLOSED), is_open, is_open
    start, end = _pair(one, "speed", (0.05, 1.0), place)
    if not any(unit in str(one.get("speedStart", one.get("speed", ""))) for unit in ("Hz", "bpm")):
        start, end = _FASTEST_STROBE * start, _FASTEST_STROBE * end
    is_random = one.get("randomTiming") is True or effect != "Strobe"
    return RANDOM_STROBE if is_random else STROBE, start, end


def _pair(one: Mapping[str, Any], name: str, default: tuple[float, float], place: str) -> tuple[float, float]:
    """Return the start and the end of a property, which may be given as one value."""
    if name in one:
        both = _entity(one[name], f"{place}: '{name}'")
        return both, both
    if f"{name}Start" not in one or f"{name}End" not in one:
        return default
    return (
        _entity(one[f"{name}Start"], f"{place}: '{name}Start'"),
        _entity(one[f"{name}End"], f"{place}: '{name}End'"),
    )


def _entity(value: Any, place: str) -> float:
    """Return an entity in rad, Hz or as a share of 1; light in lumen is no share and counts as full."""
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float(value)
    if value in _WORDS:
        return _WORDS[value]
    match = _ENTITY.fullmatch(str(value))
    if match is not None:
        return float(match[1]) * _UNITS[match[2]]
    if re.fullmatch(r"[0-9.]+\s*(lm|K|s|ms|m|ms)", str(value)):
        return 1.0
    raise FixtureError(f"{place}: '{value}' has no known unit")


def _slot(one: Mapping[str, Any], key: str, content: Mapping[str, Any]) -> tuple[str, tuple[Color, ...]]:
    """Return the name and the colours of a wheel's slot; between two slots, of both."""
    comment = str(one.get("comment", ""))
    if one.get("type") == "ColorPreset":
        colors = tuple(_hex(text) for text in one.get("colors", []) if _is_hex(text))
        return comment, colors
    if one.get("type") != "WheelSlot":
        return comment, ()
    wheels = content.get("wheels", {})
    names = one.get("wheel", key)
    wheel = wheels.get(names[0] if isinstance(names, list) and names else names) if isinstance(wheels, dict) else None
    slots = wheel.get("slots", []) if isinstance(wheel, dict) else []
    number = one.get("slotNumber", one.get("slotNumberStart", 0))
    if not isinstance(number, int | float) or not 1 <= number < len(slots) + 1:
        return comment, ()
    both = [slots[math.floor(number) - 1], slots[math.ceil(number) - 1 if number <= len(slots) else 0]]
    if both[0] is both[1]:
        both = both[:1]
    parts = [(_slot_name(one), _slot_colors(one)) for one in both]
    name = comment or " + ".join(name for name, _ in parts if name)
    return name, tuple(color for _, colors in parts for color in colors)


def _slot_name(slot: Any) -> str:
    return str(slot.get("name") or slot.get("resource") or slot.get("type", "")) if isinstance(slot, dict) else ""


def _slot_colors(slot: Any) -> tuple[Color, ...]:
    if not isinstance(slot, dict) or slot.get("type") not in ("Color", "Open"):
        return ()
    if slot["type"] == "Open":
        return ((1.0, 1.0, 1.0),)
    return tuple(_hex(text) for text in slot.get("colors", []) if _is_hex(text)) or ((1.0, 1.0, 1.0),)


def _is_hex(text: Any) -> bool:
    return isinstance(text, str) and re.fullmatch("#[0-9a-fA-F]{6}", text) is not None


def _hex(text: str) -> Color:
    red, green, blue = bytes.fromhex(text[1:])
    return red / 255, green / 255, blue / 255


def _physical(content: Mapping[str, Any]) -> dict[str, Any]:
    physical = content.get("physical", {})
    return dict(physical) if isinstance(physical, dict) else {}


def _beam_angle(physical: Mapping[str, Any]) -> float:
    lens = physical.get("lens", {})
    angles = lens.get("degreesMinMax", [2.0]) if isinstance(lens, dict) else [2.0]
    least = angles[0] if isinstance(angles, list) and angles else 2.0
    return math.radians(least) if isinstance(least, int | float) and 0 < least <= 180 else math.radians(2.0)


def _mapping(value: Any, name: str, source: str) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        raise FixtureError(f"{source}: '{name}' must be an object")
    return value
