"""Registry of sensors and plugins, with the names by which files refer to them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from daidalos.common.extensions import Kind, classes_in
from daidalos.simulation.libraries import library_name

if TYPE_CHECKING:
    from daidalos.simulation.contracts import LibraryPlugin, Sensor

SENSORS: Kind[Sensor] = Kind(
    "sensor",
    "daidalos.sensors",
    "daidalos.simulation.contracts:Sensor",
    "measures something on a simulated robot; named by the type of a <sensor>",
    partial(classes_in, "daidalos.simulation.sensors"),
)
PLUGINS: Kind[LibraryPlugin] = Kind(
    "simulator_plugin",
    "daidalos.plugins",
    "daidalos.simulation.contracts:LibraryPlugin",
    "runs beside a simulated model or inside a <sensor>; named by the file of a <plugin>",
    partial(classes_in, "daidalos.simulation.plugins"),
    library_name,
)
KINDS = (SENSORS, PLUGINS)
