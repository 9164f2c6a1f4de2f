"""A moving head as hardware of ros2_control, sent as DMX through the outputs of its configuration."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from daidalos.common.errors import UserError
from daidalos.control.contracts import Hardware, HardwareContext
from daidalos.control.errors import HardwareError
from daidalos.description.ros2_control import HardwareInfo
from daidalos.industry.lighting.configuration import DEFAULT, read_configuration
from daidalos.industry.lighting.engine import Engine
from daidalos.industry.lighting.kinematics import Angles, PointingError
from daidalos.industry.lighting.outputs import Output
from daidalos.industry.lighting.show import Show


class MovingHeadSystem(Hardware):
    """Head whose pan and tilt are the first two joints of the ``<ros2_control>`` element.

    Its parameters are ``config``, the file of heads and outputs (the built-in one where absent), ``head``, the name of
    one of its heads (the first where absent), and ``artnet_port``, which replaces the ports of Art-Net outputs. DMX has
    no way back: states are those of a head with the fixture's speed and acceleration. Active, the head
    is lit; it is dark otherwise.
    """

    names = ("daidalos_lighting/MovingHeadSystem",)

    def __init__(self, info: HardwareInfo, context: HardwareContext | None = None) -> None:
        super().__init__(info, context)
        if len(info.joints) != 2:
            raise HardwareError(f"'{info.name}' needs two joints, pan and tilt, it has {len(info.joints)}")
        self._pan, self._tilt = (f"{joint.name}/position" for joint in info.joints)
        self._name = ""
        self._engine: Engine | None = None

    def configure(self) -> None:
        """Open the outputs."""
        given = self.info.parameters
        try:
            port = int(given.get("artnet_port", "0"))
            configuration = read_configuration(Path(given["config"]) if given.get("config") else DEFAULT)
            configuration = replace(
                configuration.with_artnet_port(port),
                heads=tuple(replace(one, movement="direct") for one in configuration.heads),
            )
            show = Show(configuration.make_heads())
            self._name = show.head(given.get("head") or configuration.heads[0].name).name
            outputs: list[Output] = configuration.make_outputs()
        except (UserError, OSError, ValueError) as error:
            raise HardwareError(str(error)) from None
        self._engine = Engine(show, outputs, self.context.warn)
        self._engine.__enter__()
        self._set_states(self._engine.look_at(self._name, lambda head: head.angles), 0.0)

    def cleanup(self) -> None:
        """Close the outputs, after a blackout."""
        if self._engine is not None:
            self._engine.close()
            self._engine = None

    def activate(self) -> None:
        """Light up."""
        self._command_engine().command(self._name, lambda head: head.show(head.look))

    def deactivate(self) -> None:
        """Go dark."""
        self._command_engine().command(self._name, lambda head: head.blackout())

    def read(self, now_ns: int, period: float) -> None:
        """Compute where the head is on its way to the angles that were sent."""
        if self._engine is not None:
            self._set_states(self._engine.look_at(self._name, lambda head: head.angles), period)

    def write(self, now_ns: int, period: float) -> None:
        """Send pan and tilt where they are commanded."""
        pan, tilt = self.commands[self._pan], self.commands[self._tilt]
        current = Angles(self.states[self._pan], self.states[self._tilt])
        wanted = Angles(current.pan if math.isnan(pan) else pan, current.tilt if math.isnan(tilt) else tilt)
        if wanted == current:
            return
        try:
            self._command_engine().command(self._name, lambda head: head.turn(wanted))
        except PointingError as error:
            raise HardwareError(str(error)) from None

    def _set_states(self, angles: Angles, period: float) -> None:
        for name, value in ((self._pan, angles.pan), (self._tilt, angles.tilt)):
            speed = f"{name.removesuffix('position')}velocity"
            if speed in self.states:
                self.states[speed] = (value - self.states[name]) / period if period > 0.0 else 0.0
            self.states[name] = value

    def _command_engine(self) -> Engine:
        if self._engine is None:
            raise HardwareError("it is not configured")
        return self._engine
