"""Controllers and hardware of ros2_control that users add."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from daidalos.common.extensions import Kind, UnknownExtension, classes_in, find

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
    partial(
        classes_in,
        "daidalos.control.hardware",
        "daidalos.nodes.controller_manager",
        "daidalos.nodes.daidalos_lighting",
        "daidalos.nodes.abb_hardware_interface",
        "daidalos.nodes.kuka_kss_rsi_driver",
    ),
)
KINDS = (CONTROLLERS, HARDWARE)
MOCK = "mock_components/GenericSystem"
"""Plugin of the hardware whose states follow its commands."""


def hardware_class(info: HardwareInfo) -> type[Hardware]:
    """Return the class that a ``<ros2_control>`` element names; raises `ExtensionError` where there is none."""
    return find(HARDWARE, info.plugin, asked_by=info.location._replace(name=info.name))


def substitute_unknown(info: HardwareInfo, warn: Callable[[str], None], substitute: str = MOCK) -> HardwareInfo:
    """Return a ``<ros2_control>`` element whose plugin can be loaded, with a substitute for an unknown one.

    Robots name plugins in C++ that drive their devices; their controllers run on the substitute as well.

    Parameters
    ----------
    info : HardwareInfo
    warn : callable
        Takes a line for the user, which names the unknown plugin and where it is written.
    substitute : str
        Plugin that is used in place of an unknown one.

    Raises
    ------
    ExtensionError
        When the plugin is known and cannot be loaded.
    """
    try:
        hardware_class(info)
    except UnknownExtension:
        from daidalos.common.extensions import listing
        from daidalos.common.suggestions import near

        names = near(info.plugin, [name for extension in listing(HARDWARE) for name in extension.names])
        question = f" (did you mean {' or '.join(repr(name) for name in names)}?)" if names else ""
        warn(
            f"{info.location._replace(name=info.name).prefix()}there is no Python class for the hardware plugin "
            f"'{info.plugin}'{question}; '{substitute}' takes its place and no device is driven"
        )
        return replace(info, plugin=substitute, parameters={"calculate_dynamics": "true", **info.parameters})
    return info
