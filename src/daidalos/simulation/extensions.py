"""Registry of sensors and plugins, with the names by which files refer to them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from daidalos.common.extensions import Kind, classes_in
from daidalos.simulation.libraries import library_name

if TYPE_CHECKING:
    from daidalos.simulation.plugins.base import LibraryPlugin
    from daidalos.simulation.sensors.base import Sensor

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
