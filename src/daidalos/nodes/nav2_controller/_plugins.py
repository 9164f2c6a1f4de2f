"""Controllers and checkers as Nav2's parameter files describe them."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node

from daidalos.navigation.controllers.controller import Controller
from daidalos.navigation.controllers.mppi_controller import MppiController, default_critics
from daidalos.navigation.controllers.rotation_shim_controller import RotationShimController
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.plugins import Plugin, find_plugin
from daidalos.nodes.parameters import declare_plugin


class PluginMaker:
    """Makes plugins with the parameters of a node.

    Parameters
    ----------
    node : Node
        Whose parameters they are.
    footprint : Footprint
        Outline of the robot.
    frequency : float
        Control cycles per second.
    """

    def __init__(self, node: Node, footprint: Footprint, frequency: float) -> None:
        self._node = node
        self._footprint = footprint
        self._frequency = frequency

    def make(self, name: str, default: str) -> Any:
        """Make what the parameter ``<name>.plugin`` says.

        Raises
        ------
        UnknownPlugin
            There is no such plugin.
        """
        plugin = find_plugin(self._node.declare_parameter(f"{name}.plugin", default).value)
        if issubclass(plugin.made_by, Controller):
            return self._controller(plugin, name)
        return plugin.made_by(declare_plugin(self._node, plugin, name))

    def _controller(self, plugin: Plugin, name: str) -> Controller:
        further: dict[str, Any] = {}
        if issubclass(plugin.made_by, RotationShimController):
            further["primary"] = self._primary(name)
        elif issubclass(plugin.made_by, MppiController):
            further["critics"] = self._critics(name)
        parameters = declare_plugin(self._node, plugin, name)
        controller: Controller = plugin.made_by(
            footprint=self._footprint, parameters=parameters, control_frequency=self._frequency, **further
        )
        return controller

    def _primary(self, name: str) -> Controller:
        """Make the controller that a rotation shim wraps; its parameters stand beside the shim's."""
        default = "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController"
        chosen = self._node.declare_parameter(f"{name}.primary_controller", default).value
        return self._controller(find_plugin(chosen), name)

    def _critics(self, name: str) -> list[Any]:
        """Make the critics of an MPPI controller; those that are not enabled are left out."""
        usual = [type(critic).__name__ for critic in default_critics()]
        critics = []
        for critic in self._node.declare_parameter(f"{name}.critics", usual).value:
            plugin = find_plugin(critic)
            if self._node.declare_parameter(f"{name}.{critic}.enabled", True).value:
                critics.append(plugin.made_by(declare_plugin(self._node, plugin, f"{name}.{critic}")))
        return critics
