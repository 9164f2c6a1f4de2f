"""Controllers and hardware of ros2_control that users add."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from daidalos.common.extensions import Kind, classes_in, find

if TYPE_CHECKING:
    from daidalos.control.contracts import Controller, Hardware
    from daidalos.description.ros2_control import HardwareInfo

CONTROLLERS: Kind[Controller] = Kind(
    "controller",
    "daidalos.controllers",
    "daidalos.control.contracts:Controller",
    "turns states of hardware into commands; named by the type of a controller of the controller manager",
    partial(classes_in, "daidalos.control.controllers"),
)
HARDWARE: Kind[Hardware] = Kind(
    "hardware",
    "daidalos.hardware",
    "daidalos.control.contracts:Hardware",
    "stands between controllers and motors; named by the <plugin> of a <ros2_control> element",
    partial(classes_in, "daidalos.control.hardware", "daidalos.nodes.controller_manager"),
)
KINDS = (CONTROLLERS, HARDWARE)


def hardware_class(info: HardwareInfo) -> type[Hardware]:
    """Return the class that a ``<ros2_control>`` element names; raises `ExtensionError` where there is none."""
    return find(HARDWARE, info.plugin, asked_by=info.location._replace(name=info.name))
