"""Reader of RViz's display configurations (``.rviz``, of ROS 2 and of ROS 1)."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos.common.documents import DocumentError, parse_yaml, read_text
from daidalos.studio.arrangement import Arrangement, ArrangementError, Display, Value, View

_FIELD_OF_VIEW = math.radians(45)
_HALF_HEIGHT_PX = 400.0  # of a window, which the file does not tell in the view's own measure
_PANELS = {"slam_toolbox::SlamToolboxPlugin": "slam_toolbox"}
_AXIS_LENGTH = 0.2  # of a frame for a marker scale of 1 [m]

_Node = Mapping[str, Any]


def read_rviz(path: Path) -> Arrangement:
    """Read a display configuration.

    Raises
    ------
    ArrangementError
        When it is not a display configuration.
    OSError
        When it cannot be read.
    """
    try:
        text = read_text(path)
    except DocumentError as error:
        raise ArrangementError(path, error.line, f"not YAML: {error.problem}") from None
    return parse_rviz(text, str(path))


def parse_rviz(text: str, name: str) -> Arrangement:
    """Parse the text of a display configuration; `name` is the file's, for errors.

    Raises
    ------
    ArrangementError
        When it is not a display configuration.
    """
    try:
        document = parse_yaml(text, name)
    except DocumentError as error:
        raise ArrangementError(name, error.line, f"not YAML: {error.problem}") from None
    manager = document.get("Visualization Manager") if isinstance(document, Mapping) else None
    if not isinstance(manager, Mapping):
        raise ArrangementError(name, None, "not a display configuration: 'Visualization Manager' is missing")
    displays = tuple(_displays(manager.get("Displays"), "", "", True))
    current = _map(_map(manager.get("Views")).get("Current"))
    frame = str(current.get("Target Frame") or "")
    return Arrangement(
        fixed_frame=str(_map(manager.get("Global Options")).get("Fixed Frame") or ""),
        displays=displays,
        view=_view(current),
        followed="" if frame.startswith("<") else frame,
        panels=tuple(_panels(document.get("Panels"))),
        left_out=tuple(f"{each.name} ({each.type or 'without a class'})" for each in displays if not is_known(each)),
        source=text,
    )


def _panels(nodes: Any) -> Iterator[str]:
    """Yield the page's panels that stand for panels of RViz's plugins."""
    for node in nodes if isinstance(nodes, list) else ():
        panel = _PANELS.get(str(_map(node).get("Class")))
        if panel:
            yield panel


def is_known(display: Display) -> bool:
    """Return whether the page has this kind of display."""
    return display.type in SETTINGS


def _displays(nodes: Any, group: str, place: str, enabled: bool) -> Iterator[Display]:
    """Yield displays, those of groups among them; their origins are their numbers in the lists, such as ``3/0``."""
    for number, node in enumerate(nodes if isinstance(nodes, list) else ()):
        if not isinstance(node, Mapping):
            continue
        kind = str(node.get("Class", ""))
        name, origin = group + str(node.get("Name") or kind), f"{place}{number}"
        is_on = enabled and bool(node.get("Enabled", node.get("Value", True)))
        short = kind.rpartition("/")[2]
        if short == "Group":
            yield from _displays(node.get("Displays"), f"{name}/", f"{origin}/", is_on)
        elif short in SETTINGS:
            yield Display(short, name, is_on, _settings(short, node), origin)
        else:
            yield Display(kind, name, is_on, {}, origin)


def _topic(node: _Node) -> str:
    """Return the topic; ROS 2 keeps it with its quality of service, ROS 1 under many names."""
    for key in TOPIC_KEYS:
        value = node.get(key)
        text = value.get("Value") if isinstance(value, Mapping) else value
        if isinstance(text, str) and text:
            return text if text.startswith("/") else f"/{text}"
    return ""


def _settings(kind: str, node: _Node) -> dict[str, Value]:
    settings: dict[str, Value] = {}
    topic = _topic(node)
    if topic and kind not in WITHOUT_TOPIC:
        settings["topic"] = topic
    for entry in (*SETTINGS[kind], *OF_ALL):
        value = _find(node, entry.name)
        converted = None if value is None else entry.form.read(value)
        if converted is not None:
            settings[entry.key] = converted
    return settings


def _find(node: Any, names: str) -> Any:
    for name in names.split(LEVELS):
        node = node.get(name) if isinstance(node, Mapping) else None
    return node


def _view(current: _Node) -> View | None:
    kind = str(current.get("Class", "")).rpartition("/")[2]
    if kind in ("Orbit", "XYOrbit", "ThirdPersonFollower"):
        point = _map(current.get("Focal Point"))
        x, y, z = (_number(point.get(axis)) or 0.0 for axis in "XYZ")
        distance = _number(current.get("Distance")) or 10.0
        return View(
            "orbit", (x, y, z), distance, _number(current.get("Yaw")) or 0.0, _number(current.get("Pitch")) or 0.0
        )
    if kind == "TopDownOrtho":
        x, y, scale = (_number(current.get(name)) or 0.0 for name in ("X", "Y", "Scale"))
        return View("top", (x, y, 0.0), top_scale(abs(scale) or 40.0), 0.0, math.pi / 2)
    return None


def top_scale(value: float) -> float:
    """Return the distance [m] of a view from above with a scale [pixels/m], or the scale of a distance."""
    return _HALF_HEIGHT_PX / value / math.tan(_FIELD_OF_VIEW / 2)


def _map(value: Any) -> _Node:
    return value if isinstance(value, Mapping) else {}


def _number(value: Any) -> float | None:
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None


@dataclass(frozen=True)
class Form:
    """How a value of RViz becomes one of the page, and back; None where it cannot."""

    read: Callable[[Any], Value | None]
    write: Callable[[Value], Any]


def _times(factor: float) -> Form:
    def read(value: Any) -> float | None:
        number = _number(value)
        return None if number is None else factor * number

    return Form(read, lambda value: _plain(round(float(value) / factor, 9)))


def _plain(number: float) -> int | float:
    return int(number) if number.is_integer() else number


def _flag(value: Any) -> bool | None:
    return value if isinstance(value, bool) else None


def _color(value: Any) -> str | None:
    parts = str(value).split(";")
    if len(parts) != 3 or not all(part.strip().isdigit() for part in parts):
        return None
    return "#" + "".join(f"{min(255, int(part)):02x}" for part in parts)


def _written_color(value: Value) -> str | None:
    digits = str(value).removeprefix("#")
    if not re.fullmatch("[0-9a-fA-F]{6}", digits):
        return None
    return "; ".join(str(int(digits[i : i + 2], 16)) for i in (0, 2, 4))


def _among(choices: Mapping[str, str], default: tuple[str, str]) -> Form:
    """Return a choice: the page's values by RViz's, and what all others of both mean."""
    back = {ours: theirs for theirs, ours in choices.items()}
    return Form(lambda value: choices.get(str(value), default[1]), lambda value: back.get(str(value), default[0]))


@dataclass(frozen=True)
class Entry:
    """One setting: the page's key, RViz's name with `LEVELS` between levels, and the form of its value."""

    key: str
    name: str
    form: Form


LEVELS = " > "
TOPIC_KEYS = ("Topic", "Description Topic", "Marker Topic", "Image Topic")
WITHOUT_TOPIC = ("Grid", "TF")
_NUMBER = Form(_number, lambda value: _plain(float(value)))
_FLAG = Form(_flag, bool)
_COLOR = Form(_color, _written_color)
_BEHIND = Form(lambda behind: "behind" if behind is True else "normal", lambda layer: layer == "behind")

OF_ALL = (Entry("alpha", "Alpha", _NUMBER), Entry("color", "Color", _COLOR))
_ARROW = (Entry("length", "Arrow Length", _NUMBER), Entry("length", "Shaft Length", _times(1.4)))
_POINTS = (
    Entry("style", "Style", _among({"Points": "points"}, ("Flat Squares", "squares"))),
    Entry("pixels", "Size (Pixels)", _NUMBER),
    Entry("metres", "Size (m)", _NUMBER),
    Entry("decay", "Decay Time", _NUMBER),
)
_TRANSFORMER = "Color Transformer"
SETTINGS: dict[str, tuple[Entry, ...]] = {
    "Grid": (
        Entry("cells", "Plane Cell Count", _NUMBER),
        Entry("size", "Cell Size", _NUMBER),
        Entry("fade", "Fade", _FLAG),
    ),
    "TF": (
        Entry("axes", "Show Axes", _FLAG),
        Entry("names", "Show Names", _FLAG),
        Entry("links", "Show Arrows", _FLAG),
        Entry("scale", "Marker Scale", _times(_AXIS_LENGTH)),
    ),
    "RobotModel": (Entry("visual", "Visual Enabled", _FLAG), Entry("collision", "Collision Enabled", _FLAG)),
    "LaserScan": (
        Entry(
            "colorBy",
            _TRANSFORMER,
            _among({"Intensity": "intensity", "AxisColor": "range"}, ("FlatColor", "flat")),
        ),
        *_POINTS,
    ),
    "PointCloud2": (
        Entry(
            "colorBy",
            _TRANSFORMER,
            _among({"Intensity": "intensity", "RGB8": "rgb", "FlatColor": "flat"}, ("AxisColor", "z")),
        ),
        *_POINTS,
    ),
    "Map": (
        Entry("scheme", "Color Scheme", _among({"costmap": "costmap", "raw": "raw"}, ("map", "map"))),
        Entry("layer", "Draw Behind", _BEHIND),
    ),
    "Path": (Entry("offset", "Offset > Z", _NUMBER),),
    "Pose": _ARROW,
    "PoseArray": _ARROW,
    "PoseWithCovariance": (*_ARROW, Entry("covariance", "Covariance > Value", _FLAG)),
    "Odometry": (
        Entry("keep", "Keep", _NUMBER),
        Entry("distance", "Position Tolerance", _NUMBER),
        Entry("angle", "Angle Tolerance", _NUMBER),
        Entry("color", "Shape > Color", _COLOR),
        Entry("length", "Shape > Shaft Length", _times(1.4)),
    ),
    "Image": (),
    "Camera": (),
    "Marker": (),
    "MarkerArray": (),
    "PointStamped": (Entry("radius", "Radius", _NUMBER),),
    "Polygon": (),
}
"""The displays that the page has, by RViz's classes without their packages."""
