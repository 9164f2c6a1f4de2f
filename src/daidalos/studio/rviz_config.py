"""Reader of RViz's display configurations (``.rviz``, of ROS 2 and of ROS 1)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from daidalos.common.documents import DocumentError, read_yaml
from daidalos.studio.arrangement import Arrangement, ArrangementError, Display, Value, View

_FIELD_OF_VIEW = math.radians(45)
_HALF_HEIGHT_PX = 400.0  # of a window, which the file does not tell in the view's own measure
_AXIS_LENGTH = 0.2  # of a frame for a marker scale of 1 [m]

_Node = Mapping[str, Any]
_Conversion = Callable[[Any], Value | None]


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
        document = read_yaml(path)
    except DocumentError as error:
        raise ArrangementError(path, error.line, f"not YAML: {error.problem}") from None
    manager = document.get("Visualization Manager") if isinstance(document, Mapping) else None
    if not isinstance(manager, Mapping):
        raise ArrangementError(path, None, "not a display configuration: 'Visualization Manager' is missing")
    displays, images, left_out = [], [], []
    for node, name, enabled in _walk(manager.get("Displays"), "", True):
        kind = str(node.get("Class", "")).rpartition("/")[2]
        if kind == "Image" and (topic := _topic(node)):
            images += [topic] if enabled else []
        elif kind in _SETTINGS:
            displays.append(Display(kind, name, enabled, _settings(kind, node)))
        else:
            left_out.append(f"{name} ({node.get('Class', 'without a class')})")
    current = _map(_map(manager.get("Views")).get("Current"))
    frame = str(current.get("Target Frame") or "")
    return Arrangement(
        fixed_frame=str(_map(manager.get("Global Options")).get("Fixed Frame") or ""),
        displays=tuple(displays),
        images=tuple(images),
        view=_view(current),
        followed="" if frame.startswith("<") else frame,
        left_out=tuple(left_out),
    )


def _walk(nodes: Any, group: str, enabled: bool) -> Iterator[tuple[_Node, str, bool]]:
    """Yield displays with their names and whether they are on, those of groups among them."""
    for node in nodes if isinstance(nodes, list) else ():
        if not isinstance(node, Mapping):
            continue
        name = group + str(node.get("Name") or node.get("Class", ""))
        is_on = enabled and bool(node.get("Enabled", node.get("Value", True)))
        if str(node.get("Class", "")).endswith("/Group"):
            yield from _walk(node.get("Displays"), f"{name}/", is_on)
        else:
            yield node, name, is_on


def _topic(node: _Node) -> str:
    """Return the topic; ROS 2 keeps it with its quality of service, ROS 1 under many names."""
    for key in ("Topic", "Description Topic", "Marker Topic", "Image Topic"):
        value = node.get(key)
        text = value.get("Value") if isinstance(value, Mapping) else value
        if isinstance(text, str) and text:
            return text if text.startswith("/") else f"/{text}"
    return ""


def _settings(kind: str, node: _Node) -> dict[str, Value]:
    settings: dict[str, Value] = {}
    topic = _topic(node)
    if topic and kind not in ("Grid", "TF"):
        settings["topic"] = topic
    for key, names, convert in (*_SETTINGS[kind], *_OF_ALL):
        value = _find(node, names)
        converted = None if value is None else convert(value)
        if converted is not None:
            settings[key] = converted
    return settings


def _find(node: Any, names: str) -> Any:
    for name in names.split(" > "):
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
        distance = _HALF_HEIGHT_PX / (abs(scale) or 40.0) / math.tan(_FIELD_OF_VIEW / 2)
        return View("top", (x, y, 0.0), distance, 0.0, math.pi / 2)
    return None


def _map(value: Any) -> _Node:
    return value if isinstance(value, Mapping) else {}


def _number(value: Any) -> float | None:
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None


def _times(factor: float) -> _Conversion:
    def convert(value: Any) -> float | None:
        number = _number(value)
        return None if number is None else factor * number

    return convert


def _flag(value: Any) -> bool | None:
    return value if isinstance(value, bool) else None


def _color(value: Any) -> str | None:
    parts = str(value).split(";")
    if len(parts) != 3 or not all(part.strip().isdigit() for part in parts):
        return None
    return "#" + "".join(f"{min(255, int(part)):02x}" for part in parts)


def _among(choices: Mapping[str, str], default: str) -> _Conversion:
    return lambda value: choices.get(str(value), default)


_Entry = tuple[str, str, _Conversion]

# The page's key, RViz's name (with " > " between levels), and how one becomes the other.
_OF_ALL: tuple[_Entry, ...] = (("alpha", "Alpha", _number), ("color", "Color", _color))
_ARROW: tuple[_Entry, ...] = (("length", "Arrow Length", _number), ("length", "Shaft Length", _times(1.4)))
_POINTS: tuple[_Entry, ...] = (
    ("style", "Style", _among({"Points": "points"}, "squares")),
    ("pixels", "Size (Pixels)", _number),
    ("metres", "Size (m)", _number),
    ("decay", "Decay Time", _number),
)
_SETTINGS: dict[str, tuple[_Entry, ...]] = {
    "Grid": (("cells", "Plane Cell Count", _number), ("size", "Cell Size", _number), ("fade", "Fade", _flag)),
    "TF": (
        ("axes", "Show Axes", _flag),
        ("names", "Show Names", _flag),
        ("links", "Show Arrows", _flag),
        ("scale", "Marker Scale", _times(_AXIS_LENGTH)),
    ),
    "RobotModel": (("visual", "Visual Enabled", _flag), ("collision", "Collision Enabled", _flag)),
    "LaserScan": (
        ("colorBy", "Color Transformer", _among({"Intensity": "intensity", "AxisColor": "range"}, "flat")),
        *_POINTS,
    ),
    "PointCloud2": (
        ("colorBy", "Color Transformer", _among({"Intensity": "intensity", "RGB8": "rgb", "FlatColor": "flat"}, "z")),
        *_POINTS,
    ),
    "Map": (
        ("scheme", "Color Scheme", _among({"costmap": "costmap", "raw": "raw"}, "map")),
        ("layer", "Draw Behind", lambda behind: "behind" if behind is True else "normal"),
    ),
    "Path": (("offset", "Offset > Z", _number),),
    "Pose": _ARROW,
    "PoseArray": _ARROW,
    "PoseWithCovariance": (*_ARROW, ("covariance", "Covariance > Value", _flag)),
    "Odometry": (
        ("keep", "Keep", _number),
        ("distance", "Position Tolerance", _number),
        ("angle", "Angle Tolerance", _number),
        ("color", "Shape > Color", _color),
        ("length", "Shape > Shaft Length", _times(1.4)),
    ),
    "Marker": (),
    "MarkerArray": (),
    "PointStamped": (("radius", "Radius", _number),),
    "Polygon": (),
}
