"""Writer of RViz's display configurations: changes what the page changed, and keeps the rest as it was read."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import yaml
from yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from daidalos.studio.arrangement import Display, Value, View
from daidalos.studio.rviz_config import (
    LEVELS,
    OF_ALL,
    SETTINGS,
    TOPIC_KEYS,
    WITHOUT_TOPIC,
    Entry,
    parse_rviz,
    top_scale,
)

_PACKAGE = "rviz_default_plugins"
_LATCHED = ("Map", "RobotModel")
_FIXED = "<Fixed Frame>"
_ROUNDING = 1e-4  # [m] and [rad]
_TOOLS = ("Interact", "MoveCamera", "Select", "FocusCamera", "Measure")
_TOPIC_TOOLS = {"SetInitialPose": "/initialpose", "SetGoal": "/goal_pose", "PublishPoint": "/clicked_point"}


@dataclass(frozen=True)
class RvizState:
    """What the page shows, to be saved.

    Parameters
    ----------
    fixed_frame : str
    displays : tuple of Display
    view : View or None
        None: as in the source.
    followed : str
        The frame that the camera moves along with; empty: none.
    source : str
        The text that was read; empty: none.
    """

    fixed_frame: str
    displays: tuple[Display, ...]
    view: View | None = None
    followed: str = ""
    source: str = ""


def write_rviz(state: RvizState) -> str:
    """Return the text of a display configuration that RViz reads.

    Raises
    ------
    ArrangementError
        When the source is not a display configuration.
    """
    source = state.source or _new_source()
    before = parse_rviz(source, "the configuration to save")
    root = yaml.compose(source, yaml.SafeLoader)
    manager = _part(root, "Visualization Manager")
    displays = _part(manager, "Displays", SequenceNode)
    displays.flow_style = displays.flow_style and bool(displays.value)
    if state.fixed_frame and state.fixed_frame != before.fixed_frame:
        _set(_part(manager, "Global Options"), "Fixed Frame", state.fixed_frame)
    _write_displays(displays, state.displays, before.displays or ())
    current = _part(_part(manager, "Views"), "Current")
    if state.view is not None and _differs(state.view, before.view):
        _write_view(current, state.view)
    if state.followed != before.followed:
        _set(current, "Target Frame", state.followed or _FIXED)
    text: str = yaml.serialize(root, Dumper=yaml.SafeDumper, width=1 << 20, allow_unicode=True)
    return text


def _write_displays(nodes: SequenceNode, now: tuple[Display, ...], before: tuple[Display, ...]) -> None:
    known = {each.origin: each for each in before}
    places = dict(_places(nodes, ""))
    kept = {each.origin: each for each in now if each.origin in known}
    for origin, display in kept.items():
        _update(places[origin][1], display, known[origin])
    _switch_groups(nodes, "", kept)
    for origin in known.keys() - kept.keys():
        siblings, node = places[origin]
        siblings.value.remove(node)
    nodes.value += [_new_display(each) for each in now if each.origin not in known]


def _places(nodes: Node, place: str) -> Iterator[tuple[str, tuple[Any, MappingNode]]]:
    """Yield the origin of each display, the list that it is in, and its node."""
    for number, node in enumerate(nodes.value if isinstance(nodes, SequenceNode) else ()):
        if isinstance(node, MappingNode):
            yield f"{place}{number}", (nodes, node)
            inner = _get(node, "Displays")
            if inner is not None:
                yield from _places(inner, f"{place}{number}/")


def _switch_groups(nodes: Node, place: str, displays: dict[str, Display]) -> None:
    """Turn on the groups of displays that were turned on, with the others of a group as they are seen."""
    for number, node in enumerate(nodes.value if isinstance(nodes, SequenceNode) else ()):
        inner = _get(node, "Displays") if isinstance(node, MappingNode) else None
        if inner is None:
            continue
        within = f"{place}{number}/"
        members = {origin: each for origin, each in displays.items() if origin.startswith(within)}
        if _is_off(node) and any(each.enabled for each in members.values()):
            _enable(node, True)
            for origin, (_, member) in _places(inner, within):
                if origin in members:
                    _enable(member, members[origin].enabled)
        _switch_groups(inner, within, displays)


def _is_off(node: MappingNode) -> bool:
    value = _get(node, "Enabled") or _get(node, "Value")
    return isinstance(value, ScalarNode) and value.value.lower() == "false"


def _enable(node: MappingNode, on: bool) -> None:
    _set(node, "Enabled", on)
    _set(node, "Value", on)  # RViz has both


def _update(node: MappingNode, now: Display, before: Display) -> None:
    if now.name != before.name:
        _set(node, "Name", now.name.rpartition("/")[2] if "/" in before.origin else now.name)
    if now.enabled != before.enabled:
        _enable(node, now.enabled)
    for key, value in now.settings.items():
        if before.settings.get(key) == value or now.type not in SETTINGS:
            continue
        if key == "topic":
            _write_topic(node, now.type, str(value))
        else:
            _write_setting(node, now.type, key, value, was_there=key in before.settings)


def _write_topic(node: MappingNode, kind: str, topic: str) -> None:
    for name in TOPIC_KEYS:
        present = _get(node, name)
        if isinstance(present, MappingNode):
            return _set(present, "Value", topic)
        if present is not None:
            return _set(node, name, topic)
    latched = kind in _LATCHED
    policies = {
        "Depth": 5,
        "Durability Policy": "Transient Local" if latched else "Volatile",
        "History Policy": "Keep Last",
        "Reliability Policy": "Reliable",
        "Value": topic,
    }
    return _set(node, "Description Topic" if kind == "RobotModel" else "Topic", policies)


def _write_setting(node: MappingNode, kind: str, key: str, value: Value, *, was_there: bool) -> None:
    """Write a setting where the file has it; where it does not, under each name that it may have."""
    entries: list[Entry] = [entry for entry in (*SETTINGS[kind], *OF_ALL) if entry.key == key]
    for entry in entries:
        *levels, name = entry.name.split(LEVELS)
        holder: Node | None = node
        for level in levels:
            holder = _get(holder, level) if was_there and isinstance(holder, MappingNode) else _part(holder, level)
        if isinstance(holder, MappingNode) and (not was_there or _get(holder, name) is not None):
            written = entry.form.write(value)
            if written is not None:
                _set(holder, name, written)


def _new_display(display: Display) -> MappingNode:
    kind = display.type
    node = MappingNode("tag:yaml.org,2002:map", [], flow_style=False)
    _set(node, "Class", kind if "/" in kind else f"{_PACKAGE}/{kind}")
    _enable(node, display.enabled)
    _set(node, "Name", display.name)
    for key, value in display.settings.items() if kind in SETTINGS else ():
        if key != "topic":
            _write_setting(node, kind, key, value, was_there=False)
        elif kind not in WITHOUT_TOPIC:
            _write_topic(node, kind, str(value))
    if kind == "RobotModel":
        _set(node, "Description Source", "Topic")
    return node


def _differs(now: View, before: View | None) -> bool:
    """Return whether a view is another one, not only rounded otherwise."""
    if before is None or now.kind != before.kind:
        return True
    numbers = ((*view.focus, view.distance, view.yaw, view.pitch) for view in (now, before))
    return any(abs(a - b) > _ROUNDING for a, b in zip(*numbers, strict=True))


def _write_view(node: MappingNode, view: View) -> None:
    x, y, z = view.focus
    kind = _get(node, "Class")
    name = kind.value.rpartition("/")[2] if isinstance(kind, ScalarNode) else ""
    if view.kind == "top":
        if name != "TopDownOrtho":
            _set(node, "Class", f"{_PACKAGE}/TopDownOrtho")
        values: dict[str, Any] = {"X": x, "Y": y, "Scale": top_scale(view.distance), "Angle": 0}
    else:
        if name not in ("Orbit", "XYOrbit", "ThirdPersonFollower"):
            _set(node, "Class", f"{_PACKAGE}/Orbit")
        values = {"Distance": view.distance, "Yaw": view.yaw, "Pitch": view.pitch}
        point = _part(node, "Focal Point")
        for axis, number in zip("XYZ", (x, y, z), strict=True):
            _set(point, axis, number)
    for key, number in values.items():
        _set(node, key, number)


def _new_source() -> str:
    """Return the text of a configuration without displays, with RViz's usual panels and tools."""
    tools: list[dict[str, Any]] = [{"Class": f"{_PACKAGE}/{name}"} for name in _TOOLS]
    tools += [{"Class": f"{_PACKAGE}/{name}", "Topic": {"Value": topic}} for name, topic in _TOPIC_TOOLS.items()]
    manager = {
        "Class": "",
        "Displays": [],
        "Enabled": True,
        "Global Options": {"Background Color": "48; 48; 48", "Fixed Frame": "map", "Frame Rate": 30},
        "Name": "root",
        "Tools": tools,
        "Transformation": {"Current": {"Class": f"{_PACKAGE}/TF"}},
        "Value": True,
        "Views": {
            "Current": {
                "Class": f"{_PACKAGE}/Orbit",
                "Name": "Current View",
                "Target Frame": _FIXED,
                "Value": "Orbit (rviz)",
            },
            "Saved": None,
        },
    }
    panels = [{"Class": "rviz_common/Displays", "Name": "Displays"}, {"Class": "rviz_common/Views", "Name": "Views"}]
    text: str = yaml.safe_dump({"Panels": panels, "Visualization Manager": manager}, sort_keys=False)
    return text


def _get(node: Node | None, key: str) -> Node | None:
    pairs = node.value if isinstance(node, MappingNode) else ()
    return next((value for name, value in pairs if name.value == key), None)


def _part(node: Node | None, key: str, kind: type[Any] = MappingNode) -> Any:
    """Return what a mapping holds, made where it is not there."""
    found = _get(node, key)
    if not isinstance(found, kind):
        tag = "map" if kind is MappingNode else "seq"
        found = kind(f"tag:yaml.org,2002:{tag}", [], flow_style=False)
        _put(node, key, found)
    return found


def _set(node: Node, key: str, value: Any) -> None:
    _put(node, key, yaml.representer.SafeRepresenter(default_flow_style=False, sort_keys=False).represent_data(value))


def _put(node: Node | None, key: str, value: Node) -> None:
    assert isinstance(node, MappingNode)
    for place, (name, _) in enumerate(node.value):
        if name.value == key:
            node.value[place] = (name, value)
            return
    node.value.append((ScalarNode("tag:yaml.org,2002:str", key), value))
