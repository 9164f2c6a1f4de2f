"""Registry of sensors and plugins, with the names by which files refer to them."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING

from daidalos.common.extensions import Kind, classes_in

if TYPE_CHECKING:
    from daidalos.description.link import Plugin as Description
    from daidalos.simulation.plugins.base import LibraryPlugin
    from daidalos.simulation.sensors.base import Sensor

# What Gazebo leaves to plugins and this simulator does by itself.
_BUILT_IN = re.compile(
    r"gazebo_ros_(init|factory|api_plugin|paths_plugin|properties|state|force_system)"
    r"|gz-sim-(physics|user-commands|scene-broadcaster|sensors|imu|contact|forcetorque|force-torque|altimeter"
    r"|magnetometer|nav-?sat|air-pressure|apply-link-wrench|logical-camera|label|particle-emitter|performer)-system"
)


def library_name(filename: str) -> str:
    """Return the name of a library without platform-specific prefixes, suffixes and versions.

    ``libgazebo_ros_imu.so`` becomes ``gazebo_ros_imu``; ``libignition-gazebo6-imu-system.so``,
    ``gz-sim8-imu-system`` and gz's class name ``gz::sim::systems::Imu`` become ``gz-sim-imu-system``.
    """
    name = filename.strip().replace("\\", "/").rpartition("/")[2]
    system = re.fullmatch(r"(?:gz::sim|ignition::gazebo)(?:::v\d+)?::systems(?:::v\d+)?::(\w+)", name)
    if system:
        return f"gz-sim-{re.sub('(?<=[a-z])(?=[A-Z])', '-', system[1]).lower()}-system"
    name = re.sub(r"\.(so|dll|dylib)$", "", name).removeprefix("lib")
    return re.sub(r"^(ignition-gazebo|gz-sim)\d*-", "gz-sim-", name)


def library_of(plugin: Description) -> str:
    """Return the name of a plugin's library; gz's class name takes precedence for non-gz libraries."""
    library = library_name(plugin.filename)
    is_class = "::systems::" in plugin.name and not re.fullmatch("gz-sim-.*-system", library)
    return library_name(plugin.name) if is_class else library


def is_built_in(plugin: Description) -> bool:
    """Return whether a plugin requests something that is built into the simulator."""
    return _BUILT_IN.fullmatch(library_of(plugin)) is not None


SENSORS: Kind[Sensor] = Kind(
    "sensor",
    "daidalos.sensors",
    "daidalos.simulation.sensors.base:Sensor",
    "measures something on a simulated robot; named by the type of a <sensor>",
    partial(classes_in, "daidalos.simulation.sensors"),
)
PLUGINS: Kind[LibraryPlugin] = Kind(
    "simulator_plugin",
    "daidalos.plugins",
    "daidalos.simulation.plugins.base:LibraryPlugin",
    "runs beside a simulated model or inside a <sensor>; named by the file of a <plugin>",
    partial(classes_in, "daidalos.simulation.plugins"),
    library_name,
)
KINDS = (SENSORS, PLUGINS)
