"""Forward controllers: commands are written to the interfaces unchanged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import Parameters, parameter
from daidalos.control.contracts import Controller, Subscription
from daidalos.control.interfaces import Interfaces
from daidalos.samples.controllers import ValuesCommand
from daidalos.samples.sensors import Sample


@dataclass(frozen=True)
class ForwardCommandParameters(Parameters):
    """Joints, and the commanded interface of each."""

    joints: tuple[str, ...] = parameter(
        (), "Joints that are commanded, in the order of the command's values.", not_empty=True, unique=True,
        read_only=True,
    )  # fmt: skip
    interface_name: str = parameter("", "Interface of each joint.", not_empty=True, read_only=True)


@dataclass(frozen=True)
class MultiInterfaceParameters(Parameters):
    """Joint, and its commanded interfaces."""

    joint: str = parameter("", "Joint that is commanded.", not_empty=True, read_only=True)
    interface_names: tuple[str, ...] = parameter(
        (), "Its interfaces, in the order of the command's values.", not_empty=True, unique=True, read_only=True
    )


@dataclass(frozen=True)
class GroupParameters(Parameters):
    """Joints of a group controller."""

    joints: tuple[str, ...] = parameter(
        (), "Joints that are commanded, in the order of the command's values.", not_empty=True, unique=True,
        read_only=True,
    )  # fmt: skip


@dataclass(frozen=True)
class PassthroughParameters(Parameters):
    """Commanded interfaces."""

    interfaces: tuple[str, ...] = parameter(
        (), "Commanded interfaces, in the order of the command's values.", not_empty=True, unique=True, read_only=True
    )


class ForwardController(Controller):
    """Base of the controllers that forward ``~/commands``, in the order of the interfaces."""

    chainable = True

    def interfaces(self) -> tuple[str, ...]:
        """Return the names of the commanded interfaces."""
        raise NotImplementedError

    def configure(self) -> None:
        """Set the interface names, and export each as a reference."""
        self.command_names = self.interfaces()
        self.references = Interfaces(self.command_names)
        self._received: np.ndarray | None = None

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Commands, in the order of the interfaces."""
        return {"~/commands": Subscription(ValuesCommand, self._take)}

    def _take(self, command: ValuesCommand) -> None:
        count = len(self.command_names)
        if len(command.values) != count:
            self.context.warn(f"command has {len(command.values)} values instead of {count}; it is not executed")
            return
        self._received = np.asarray(command.values, dtype=np.float64)

    def activate(self, now_ns: int) -> None:
        """Clear the references until the first command."""
        self._received = None
        self.references.values[:] = np.nan

    def deactivate(self) -> None:
        """Drop the command."""
        self._received = None

    def take_references(self, now_ns: int, period: float) -> None:
        """Apply the last received references."""
        if self._received is not None:
            self.references.values[:] = self._received

    def update(self, now_ns: int, period: float) -> tuple[Sample, ...]:
        """Write the known references; interfaces without one keep their command."""
        wanted = self.references.values
        unknown = np.isnan(wanted)
        if unknown.any():
            if unknown.all():
                return ()
            wanted = np.where(unknown, self.commands.read(), wanted)
        self.commands.write(wanted)
        return ()


class ForwardCommandController(ForwardController):
    """Forward controller of one interface of several joints."""

    names = ("forward_command_controller/ForwardCommandController",)
    Parameters = ForwardCommandParameters
    parameters: ForwardCommandParameters

    def interfaces(self) -> tuple[str, ...]:
        """Return the interface of each joint."""
        return tuple(f"{joint}/{self.parameters.interface_name}" for joint in self.parameters.joints)


class MultiInterfaceForwardCommandController(ForwardController):
    """Forward controller of several interfaces of one joint."""

    names = ("forward_command_controller/MultiInterfaceForwardCommandController",)
    Parameters = MultiInterfaceParameters
    parameters: MultiInterfaceParameters

    def interfaces(self) -> tuple[str, ...]:
        """Return the joint's interfaces."""
        return tuple(f"{self.parameters.joint}/{name}" for name in self.parameters.interface_names)


class PassthroughController(ForwardController):
    """Forward controller of any interfaces, those of other controllers among them."""

    names = ("passthrough_controller/PassthroughController",)
    Parameters = PassthroughParameters
    parameters: PassthroughParameters

    def interfaces(self) -> tuple[str, ...]:
        """Return the interfaces as they are given."""
        return self.parameters.interfaces


class JointGroupPositionController(ForwardController):
    """Forward controller of joint positions."""

    names = ("position_controllers/JointGroupPositionController",)
    Parameters = GroupParameters
    kind = "position"
    parameters: GroupParameters

    def interfaces(self) -> tuple[str, ...]:
        """Return the interface of each joint."""
        return tuple(f"{joint}/{self.kind}" for joint in self.parameters.joints)


class JointGroupVelocityController(JointGroupPositionController):
    """Forward controller of joint velocities; they are zero after deactivation."""

    names = ("velocity_controllers/JointGroupVelocityController",)
    kind = "velocity"

    def deactivate(self) -> None:
        """Stop."""
        super().deactivate()
        self.commands.write(np.zeros(len(self.command_names)))


class JointGroupEffortController(JointGroupVelocityController):
    """Forward controller of joint efforts; they are zero after deactivation."""

    names = ("effort_controllers/JointGroupEffortController",)
    kind = "effort"
