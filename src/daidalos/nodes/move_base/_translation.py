"""Translation of `move_base`'s parameters into those of Nav2's servers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from daidalos.common.errors import Location
from daidalos.common.extensions import find
from daidalos.navigation.costmap.layers.obstacle_layer import ObservationSource
from daidalos.navigation.extensions import CONTROLLERS as CONTROLLER_KIND
from daidalos.navigation.extensions import COSTMAP_LAYERS
from daidalos.navigation.extensions import PLANNERS as PLANNER_KIND
from daidalos.nodes.move_base._parameters import MoveBaseParameters, plugin_list
from daidalos.nodes.move_base._plugins import CHECKER, CONTROLLERS, GOAL_DEFAULTS, PLANNERS, Successor, typed
from daidalos.nodes.nav2_costmap_2d._costmap_node import CostmapNodeParameters

COSTMAPS = ("global_costmap", "local_costmap")
NEVER = 1e9
"""Time [s] that a robot may stand: ROS 1 has `oscillation_timeout` in place of a progress checker."""
RETRY_S = 1.0
"""How long the controller fails before there is another plan, unless `controller_patience` is shorter."""
_FRAMES = ("global_frame", "robot_base_frame")
_SOURCE = {"obstacle_range": "obstacle_max_range", "raytrace_range": "raytrace_max_range"}


@dataclass
class Translation:
    """Parameters of the servers, by their names below that of `move_base`, and what was used of the given ones."""

    nodes: dict[str, dict[str, Any]] = field(default_factory=dict)
    used: set[str] = field(default_factory=set)
    without_effect: set[str] = field(default_factory=set)
    controller: str = ""
    planner: str = ""


def translate(p: MoveBaseParameters, given: Mapping[str, Any], namespace: str, odom_topic: str) -> Translation:
    """Return the parameters of the servers.

    Parameters
    ----------
    p : MoveBaseParameters
    given : mapping
        All parameters that the node was given, by their names with dots.
    namespace : str
        In which relative topics of sensors and maps stand, without a slash at its end.
    odom_topic : str
        Where odometry is.

    Raises
    ------
    UserError
        A value is of the wrong type, or there is no such plugin.
    """
    found = Translation()
    planner = _plugin(found, given, "base_global_planner", p.base_global_planner, PLANNERS, PLANNER_KIND)
    controller = _plugin(found, given, "base_local_planner", p.base_local_planner, CONTROLLERS, CONTROLLER_KIND)
    found.planner, found.controller = p.base_global_planner, p.base_local_planner
    goal = dict(GOAL_DEFAULTS.get(_short(p.base_local_planner), {}))
    for name, new in CHECKER.items():
        full = f"{_short(p.base_local_planner)}.{name}"
        if full in given:
            goal[new] = given[full] if new == "stateful" else float(given[full])
            found.used.add(full)
        controller.pop(name, None)
    odom = f"{_short(p.base_local_planner)}.odom_topic"
    if odom in given:
        found.used.add(odom)
        odom_topic = _absolute(str(given[odom]), namespace)
        controller.pop("odom_topic", None)
    found.nodes["planner_server"] = {
        "planner_plugins": [_short(p.base_global_planner)],
        "expected_planner_frequency": 0.0,
        _short(p.base_global_planner): planner,
    }
    found.nodes["controller_server"] = {
        "controller_frequency": p.controller_frequency,
        "failure_tolerance": min(p.controller_patience, RETRY_S),
        "odom_topic": odom_topic,
        "controller_plugins": [_short(p.base_local_planner)],
        "goal_checker_plugins": ["goal_checker"],
        "progress_checker_plugins": ["progress_checker"],
        _short(p.base_local_planner): controller,
        "goal_checker": {"plugin": "nav2_controller::SimpleGoalChecker", **goal},
        "progress_checker": {
            "plugin": "nav2_controller::SimpleProgressChecker",
            "required_movement_radius": 0.0,
            "movement_time_allowance": NEVER,
        },
    }
    for name in COSTMAPS:
        found.nodes[f"{name}/{name}"] = _costmap(found, given, name, namespace)
    local = found.nodes["local_costmap/local_costmap"]
    found.nodes["behavior_server"] = {
        "local_frame": local["global_frame"],
        "robot_base_frame": local["robot_base_frame"],
        "behavior_plugins": ["spin"],
        "spin": {"plugin": "nav2_behaviors::Spin"},
    }
    return found


def _plugin(
    found: Translation, given: Mapping[str, Any], parameter: str, name: str, successors: Mapping[str, Successor],
    kind: Any,
) -> dict[str, Any]:  # fmt: skip
    """Return the parameters of a planner or controller, with its class."""
    successor = successors.get(name.replace("::", "/"), Successor(name))
    prefix = f"{_short(name)}."
    values: dict[str, Any] = dict(successor.defaults)
    for full, value in given.items():
        if not full.startswith(prefix):
            continue
        old = full.removeprefix(prefix)
        found.used.add(full)
        new = successor.renamed.get(old, old)
        if new is None:
            found.without_effect.add(full)
        elif new == "use_dijkstra":
            values["use_astar"] = not value
        elif not (new == "min_speed_theta" and value < 0.0):  # of turns to the right, not the least rate
            values.update(dict.fromkeys([new] if isinstance(new, str) else new, value))
    for axis in ("x", "y", "theta"):
        if "decel_lim_x" in successor.defaults and f"acc_lim_{axis}" in values:
            values[f"decel_lim_{axis}"] = -float(values[f"acc_lim_{axis}"])
    cls: Any = find(kind, successor.plugin, asked_by=Location(name=parameter))
    return {"plugin": successor.plugin, **typed(cls.Parameters, values, _short(name))}


def _costmap(found: Translation, given: Mapping[str, Any], name: str, namespace: str) -> dict[str, Any]:
    """Return the parameters of a costmap with its layers."""
    prefix = f"{name}."
    own = {full.removeprefix(prefix): value for full, value in given.items() if full.startswith(prefix)}
    for frame in _FRAMES:
        if frame in own:
            own[frame] = str(own[frame]).removeprefix("/")
    is_local = name == "local_costmap"
    values: dict[str, Any] = {
        "global_frame": "odom" if is_local else "map",
        "robot_base_frame": "base_link",
        "rolling_window": is_local,
        "update_frequency": 5.0,
        "publish_frequency": 1.0,
        "map_topic": _absolute(str(own.get("map_topic", "map")), namespace),
    }
    layers = _layers(own)
    values["plugins"] = [layer for layer, _ in layers]
    taken = {"static_map", "map_type", "plugins", "map_topic"}
    known = {leaf for leaf in _leaf_names(CostmapNodeParameters) if leaf not in ("plugins", "filters", "map_topic")}
    values |= typed(CostmapNodeParameters, {key: own[key] for key in own if key in known}, name)
    taken |= known
    for layer, plugin in layers:
        values[layer] = _layer(own, layer, plugin, taken, namespace)
    if "footprint" in own and str(own["footprint"]).strip() not in ("", "[]"):
        values.pop("robot_radius", None)
    found.used |= {f"{prefix}{key}" for key in own if key in taken}
    return values


def _layers(own: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return the names and plugins of a costmap's layers: those of `plugins`, or those of `map_type`."""
    if own.get("plugins"):
        return [(name, f"nav2_{kind}" if kind.startswith("costmap_2d::") else kind) for name, kind in
                plugin_list(str(own["plugins"]), "plugins")]  # fmt: skip
    has_map = own.get("static_map", not own.get("rolling_window", False))
    obstacles = "nav2_costmap_2d::VoxelLayer" if own.get("map_type") == "voxel" else "nav2_costmap_2d::ObstacleLayer"
    return [
        *([("static_layer", "nav2_costmap_2d::StaticLayer")] if has_map else []),
        ("obstacle_layer", obstacles),
        ("inflation_layer", "nav2_costmap_2d::InflationLayer"),
    ]


def _layer(own: Mapping[str, Any], layer: str, plugin: str, taken: set[str], namespace: str) -> dict[str, Any]:
    """Return the parameters of a layer, which may stand below its name or, as in older files, beside the costmap's."""
    cls: Any = find(COSTMAP_LAYERS, plugin, asked_by=Location(name=f"{layer}.type"))
    names = _leaf_names(cls.Parameters) if cls.Parameters is not None else set()
    values: dict[str, Any] = {"plugin": plugin}
    flat = {key: own[key] for key in own if key in names}
    below = {key.removeprefix(f"{layer}."): own[key] for key in own if key.startswith(f"{layer}.")}
    taken |= set(flat) | {f"{layer}.{key}" for key in below}
    merged = {**flat, **below}
    values |= typed(cls.Parameters, {key: merged[key] for key in merged if key in names}, layer)
    if "map_topic" in values:
        values["map_topic"] = _absolute(values["map_topic"], namespace)
    if "observation_sources" in names:
        ranges = {new: source[old] for source in (own, below) for old, new in _SOURCE.items() if old in source}
        taken |= set(_SOURCE)
        values["observation_sources"] = sources = str(merged.get("observation_sources", ""))
        for source in sources.split():
            values[source] = _source(own, below, source, ranges, taken, namespace)
    return values


def _source(
    own: Mapping[str, Any], below: Mapping[str, Any], source: str, ranges: Mapping[str, Any], taken: set[str],
    namespace: str,
) -> dict[str, Any]:  # fmt: skip
    """Return the parameters of a sensor; the ranges of its layer hold where it has none of its own."""
    prefix = f"{source}."
    given = {key.removeprefix(prefix): group[key] for group in (own, below) for key in group if key.startswith(prefix)}
    taken |= {key for key in own if key.startswith(prefix)}
    given = {_SOURCE.get(key, key): value for key, value in given.items() if key != "sensor_frame"}
    if given.get("expected_update_rate") == 0:
        given.pop("expected_update_rate")  # half a second: the robot does not drive on without its sensor
    given["topic"] = _absolute(str(given.get("topic", source)), namespace)
    return typed(ObservationSource, {**ranges, **given}, source)


def _leaf_names(kind: type) -> set[str]:
    from daidalos.common.parameters import leaves

    return {leaf.name for leaf in leaves(kind) if "<" not in leaf.name}


def _short(name: str) -> str:
    """Return the name below which a plugin's parameters stand: that of its class."""
    return name.replace("::", "/").rsplit("/", 1)[-1]


def _absolute(topic: str, namespace: str) -> str:
    return topic if topic.startswith("/") else f"{namespace}/{topic}"
