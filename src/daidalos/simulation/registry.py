"""Finds the class for a sensor's type and for a plugin's file name, ours and the user's."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from collections.abc import Iterator
from functools import cache
from importlib.metadata import entry_points
from types import ModuleType
from typing import TypeVar

from daidalos.description.link import Plugin as Description
from daidalos.simulation import plugins as plugin_package
from daidalos.simulation import sensors as sensor_package
from daidalos.simulation.plugins.base import Plugin, SensorPlugin, library_name, library_of
from daidalos.simulation.sensors.base import Sensor

T = TypeVar("T")

SENSOR_GROUP = "daidalos.sensors"
PLUGIN_GROUP = "daidalos.plugins"

# What Gazebo leaves to plugins and this simulator does by itself.
_BUILT_IN = re.compile(
    r"gazebo_ros_(init|factory|api_plugin|paths_plugin|properties|state|force_system)"
    r"|gz-sim-(physics|user-commands|scene-broadcaster|sensors|imu|contact|forcetorque|force-torque|altimeter"
    r"|magnetometer|nav-?sat|air-pressure|apply-link-wrench|logical-camera|label|particle-emitter|performer)-system"
)


def sensor_class(kind: str) -> type[Sensor] | None:
    """Return the class for an SDF sensor type; None when there is none."""
    return _sensors().get(kind)


def plugin_class(plugin: Description) -> type[Plugin] | type[SensorPlugin] | None:
    """Return the class for a plugin; None when there is none."""
    return _plugins().get(library_of(plugin))


def is_built_in(plugin: Description) -> bool:
    """Tell whether a plugin asks for what the simulator does anyway."""
    return _BUILT_IN.fullmatch(library_of(plugin)) is not None


@cache
def _sensors() -> dict[str, type[Sensor]]:
    found: dict[str, type[Sensor]] = {}
    for cls in _classes(sensor_package, Sensor):
        found |= dict.fromkeys(cls.types, cls)
    for entry in entry_points(group=SENSOR_GROUP):
        found[entry.name] = entry.load()
    return found


@cache
def _plugins() -> dict[str, type[Plugin] | type[SensorPlugin]]:
    found: dict[str, type[Plugin] | type[SensorPlugin]] = {}
    for plugin in _classes(plugin_package, Plugin):
        found |= dict.fromkeys(plugin.names, plugin)
    sensor_plugins: Iterator[type[SensorPlugin]] = _classes(plugin_package, SensorPlugin)  # type: ignore[type-abstract]
    for sensor_plugin in sensor_plugins:
        found |= dict.fromkeys(sensor_plugin.names, sensor_plugin)
    for entry in entry_points(group=PLUGIN_GROUP):
        found[library_name(entry.name)] = entry.load()
    return found


def _classes(package: ModuleType, base: type[T]) -> Iterator[type[T]]:
    """Yield the subclasses of `base` that the modules of a package define."""
    for info in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
        module = importlib.import_module(info.name)
        for _, cls in inspect.getmembers(module, inspect.isclass):
            if issubclass(cls, base) and cls.__module__ == module.__name__:
                yield cls
