"""Messages of a head over MQTT: points, channels of a dashboard and looks in, states and errors out, all in JSON."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

from daidalos.common.errors import UserError
from daidalos.common.pose3 import Vector
from daidalos.common.suggestions import hint
from daidalos.industry.lighting.head import Head
from daidalos.industry.lighting.look import Look, parse_color

MAX_BYTES = 1 << 16
POINT, DASHBOARD, LOOK, BLACKOUT = "point", "dashboard", "look", "blackout"
PROPERTIES = (POINT, DASHBOARD, LOOK, BLACKOUT)
"""Properties that take commands, the last part of a topic ``{device}/{property}``."""

_LOOK_KEYS = ("dimmer", "color", "gobo", "zoom_deg", "strobe")


class MessageError(UserError, ValueError):
    """Error of a message; it names what was expected."""


def parse(name: str, payload: bytes) -> Any:
    """Return the content of a message to one of `PROPERTIES`.

    A point is a tuple of three numbers [m]; the dashboard's channels are values by number; a look is a dictionary with
    the changes; a blackout is True.

    Raises
    ------
    MessageError
        When it is not of the right form.
    """
    if len(payload) > MAX_BYTES:
        raise MessageError(f"the message has {len(payload)} bytes, at most {MAX_BYTES} are allowed")
    if name == BLACKOUT:
        return True
    try:
        content = json.loads(payload)
    except (ValueError, RecursionError):
        raise MessageError(f"is not valid JSON; {_EXPECTED[name]}") from None
    return {POINT: _point, DASHBOARD: _dashboard, LOOK: _look}[name](content)


_EXPECTED = {
    POINT: "expected [x, y, z] in metres",
    DASHBOARD: 'expected {"buckets": [{"channel": 6, "value": 255}]}',
    LOOK: 'expected {"dimmer": 0.5, "color": "#ff0000"}',
}


def apply_look(look: Look, changes: dict[str, Any]) -> Look:
    """Return a look with the changes of a message."""
    changed = dict(changes)
    if "color" in changed:
        changed["color"] = parse_color(changed["color"])
    if "zoom_deg" in changed:
        changed["zoom"] = math.radians(changed.pop("zoom_deg"))
    return replace(look, **changed)


def state(head: Head, point: Vector | None) -> str:
    """Return the state of a head as JSON: angles [deg], the point [m] that it aims at, and its channels."""
    angles, look = head.angles, head.look
    color = look.color if isinstance(look.color, str) else "#" + bytes(round(255 * one) for one in look.color).hex()
    return json.dumps(
        {
            "pan_deg": round(math.degrees(angles.pan), 4),
            "tilt_deg": round(math.degrees(angles.tilt), 4),
            "point": None if point is None else list(point),
            "moving": head.is_moving,
            "lit": head.is_lit,
            "dimmer": look.dimmer,
            "color": color,
            "channels": list(head.levels),
        }
    )


def error(topic: str, problem: str, payload: bytes) -> str:
    """Return an error as JSON: the topic, the reason, and the beginning of the message."""
    return json.dumps({"topic": topic, "error": problem, "message": payload[:200].decode("utf-8", "replace")})


def _point(content: Any) -> Vector:
    if isinstance(content, list) and len(content) == 3 and all(_is_finite(one) for one in content):
        x, y, z = (float(one) for one in content)
        return x, y, z
    raise MessageError(f"is no point; {_EXPECTED[POINT]}, all of them finite numbers")


def _dashboard(content: Any) -> dict[int, int]:
    buckets = content.get("buckets") if isinstance(content, dict) else None
    if not isinstance(buckets, list):
        raise MessageError(f"has no list 'buckets'; {_EXPECTED[DASHBOARD]}")
    values = {}
    for index, bucket in enumerate(buckets):
        if not isinstance(bucket, dict) or not {"channel", "value"} <= bucket.keys():
            raise MessageError(f"buckets[{index}] needs 'channel' and 'value'; {_EXPECTED[DASHBOARD]}")
        channel, value = (_integer(bucket[key], f"buckets[{index}]: '{key}'") for key in ("channel", "value"))
        values[channel] = value
    return values


def _look(content: Any) -> dict[str, Any]:
    if not isinstance(content, dict):
        raise MessageError(f"is no look; {_EXPECTED[LOOK]}")
    for key, value in content.items():
        if key not in _LOOK_KEYS:
            raise MessageError(f"'{key}' is unknown{hint(key, _LOOK_KEYS)}")
        wants_text = key in ("color", "gobo")
        if wants_text != isinstance(value, str) or not (wants_text or _is_finite(value)):
            raise MessageError(f"'{key}' must be {'a string' if wants_text else 'a finite number'}, got {value!r}")
    return content


def _is_finite(value: Any) -> bool:
    """Return whether a value is a number of reasonable size; JSON's NaN and Infinity are none."""
    return type(value) in (int, float) and abs(value) < 1e9


def _integer(value: Any, what: str) -> int:
    """Return an integer; sliders of dashboards send 6.0 as well."""
    if _is_finite(value) and value == int(value):
        return int(value)
    raise MessageError(f"{what} must be an integer, got {value!r}")
