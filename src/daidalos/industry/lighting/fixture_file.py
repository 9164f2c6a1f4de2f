"""Reader of fixture files in YAML, and of those of the Open Fixture Library in JSON."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from daidalos.common.documents import parse_json, parse_yaml, read_text
from daidalos.common.suggestions import hint
from daidalos.industry.lighting.fixture import (
    ANGLES,
    CLOSED,
    FUNCTIONS,
    OPEN,
    RANDOM_STROBE,
    STROBE,
    Channel,
    Color,
    Fixture,
    FixtureError,
    ValueRange,
)
from daidalos.industry.lighting.look import parse_color
from daidalos.industry.lighting.open_fixture_library import fixture_from_json

BUILT_IN = Path(__file__).parents[2] / "share" / "daidalos_lighting" / "fixtures"
_KEYS = ("name", "mode", "beam_angle_deg", "pan_speed_deg", "tilt_speed_deg", "acceleration_deg", "channels")
_CHANNEL_KEYS = ("name", "fine", "default", "values")
_RANGE_KEYS = ("range", "function", "from", "to", "name", "colors")


def read_fixture(name: str, mode: str = "", folder: Path | None = None) -> Fixture:
    """Return a built-in fixture, or one of a file: ``.json`` of the Open Fixture Library, else YAML.

    Parameters
    ----------
    name : str
        A built-in name, or a path.
    mode : str
        Name of one of the modes; the first where empty.
    folder : Path, optional
        What relative paths begin at.

    Raises
    ------
    FixtureError, DocumentError, OSError
        When it cannot be read.
    """
    built_in = {path.stem: path for path in BUILT_IN.glob("*.yaml")}
    if name in built_in:
        path = built_in[name]
    elif "." in name or "/" in name:
        path = (folder or Path()) / name
    else:
        raise FixtureError(f"'{name}' is no built-in fixture and no path of a file{hint(name, built_in)}")
    text = read_text(path)
    if path.suffix == ".json":
        return fixture_from_json(parse_json(text, str(path)), mode, str(path))
    fixture = fixture_from_yaml(parse_yaml(text, str(path)), str(path))
    if mode not in ("", fixture.mode):
        raise FixtureError(f"{path}: '{mode}' is no mode{hint(mode, [fixture.mode])}")
    return fixture


def fixture_from_yaml(content: Any, source: str) -> Fixture:
    """Return the fixture of a YAML document; see ``docs/moving-head.md`` for its form.

    Raises
    ------
    FixtureError
        Naming the file and the entry.
    """
    entry = _mapping(content, _KEYS, source)
    items = entry.get("channels")
    if not isinstance(items, list) or not 1 <= len(items) <= 512:
        raise FixtureError(f"{source}: 'channels' must be a list of 1 to 512 channels")
    fine: dict[str, list[int]] = {}
    coarse: list[tuple[int, Mapping[str, Any], str]] = []
    for offset, item in enumerate(items):
        place = f"{source}: channel {offset + 1}"
        one = _mapping(item, _CHANNEL_KEYS, place)
        if "fine" in one:
            fine.setdefault(str(one["fine"]), []).append(offset)
        else:
            coarse.append((offset, one, place))
    names = {_name(one, place) for _, one, place in coarse}
    for name, offsets in fine.items():
        if name not in names:
            raise FixtureError(f"{source}: channel {offsets[0] + 1} is the fine one of '{name}', which is not there")
    channels = tuple(_channel(one, (offset, *fine.get(str(one["name"]), ())), place) for offset, one, place in coarse)
    degrees = {key: _number(entry.get(key, default), f"{source}: '{key}'", least=1e-3) for key, default in _DEFAULTS}
    return Fixture(
        name=str(entry.get("name", Path(source).stem)),
        mode=str(entry.get("mode", f"{len(items)}-channel")),
        size=len(items),
        channels=channels,
        beam_angle=math.radians(degrees["beam_angle_deg"]),
        pan_speed=math.radians(degrees["pan_speed_deg"]),
        tilt_speed=math.radians(degrees["tilt_speed_deg"]),
        acceleration=math.radians(degrees["acceleration_deg"]),
        source=source,
    )


_DEFAULTS = (
    ("beam_angle_deg", 2.0), ("pan_speed_deg", 230.0), ("tilt_speed_deg", 230.0), ("acceleration_deg", 1150.0),
)  # fmt: skip


def _channel(one: Mapping[str, Any], offsets: tuple[int, ...], place: str) -> Channel:
    most = (1 << 8 * len(offsets)) - 1
    items = one.get("values", [])
    if not isinstance(items, list):
        raise FixtureError(f"{place}: 'values' must be a list")
    ranges = tuple(_range(item, len(offsets), f"{place}: values[{index}]") for index, item in enumerate(items))
    for before, after in itertools.pairwise(ranges):
        if after.first <= before.last:
            raise FixtureError(f"{place}: the range {after.first} to {after.last} begins within the one before it")
    default = one.get("default", 0)
    if type(default) is not int or not 0 <= default <= most:
        raise FixtureError(f"{place}: 'default' must be an integer from 0 to {most}, got {default!r}")
    return Channel(_name(one, place), offsets, default, ranges)


def _range(item: Any, width: int, place: str) -> ValueRange:
    one = _mapping(item, _RANGE_KEYS, place)
    function = one.get("function")
    if function not in FUNCTIONS:
        raise FixtureError(f"{place}: '{function}' is no function{hint(str(function), FUNCTIONS)}")
    first, last = _bounds(one.get("range", [0, 255]), place)
    shift = 8 * (width - 1)
    default = (1.0, 10.0) if function in (STROBE, RANDOM_STROBE) else (0.0, 1.0)
    start = _number(one.get("from", default[0]), f"{place}: 'from'")
    end = _number(one.get("to", default[1]), f"{place}: 'to'")
    if function in ANGLES:
        start, end = math.radians(start), math.radians(end)
    elif function in (OPEN, CLOSED):
        start = end = float(function == OPEN)
    colors = one.get("colors", [])
    if not isinstance(colors, list):
        raise FixtureError(f"{place}: 'colors' must be a list of '#rrggbb'")
    return ValueRange(
        first << shift, (last + 1 << shift) - 1, str(function), start, end, str(one.get("name", "")),
        tuple(_hex_color(text, place) for text in colors),
    )  # fmt: skip


def _hex_color(text: Any, place: str) -> Color:
    color = parse_color(str(text))
    if isinstance(color, str):
        raise FixtureError(f"{place}: '{text}' is no colour; write '#rrggbb'")
    return color


def _bounds(value: Any, place: str) -> tuple[int, int]:
    if isinstance(value, list) and len(value) == 2 and all(type(one) is int for one in value):
        first, last = value
        if 0 <= first <= last <= 255:
            return first, last
    raise FixtureError(f"{place}: 'range' must be [first, last] from 0 to 255, got {value!r}")


def _mapping(value: Any, keys: tuple[str, ...], place: str) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        raise FixtureError(f"{place}: must be a mapping with {', '.join(keys)}")
    for key in value:
        if key not in keys:
            raise FixtureError(f"{place}: '{key}' is unknown{hint(str(key), keys)}")
    return value


def _name(one: Mapping[str, Any], place: str) -> str:
    if not one.get("name"):
        raise FixtureError(f"{place}: needs a 'name', or 'fine' with the name of another channel")
    return str(one["name"])


def _number(value: Any, place: str, least: float = -math.inf) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value) or value < least:
        raise FixtureError(f"{place} must be a number{f' of at least {least:g}' if least > 0 else ''}, got {value!r}")
    return float(value)
