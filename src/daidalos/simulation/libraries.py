"""Names of the libraries of Gazebo's plugins."""

from __future__ import annotations

import re

from daidalos.description.link import Plugin as Description

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
