"""PID controller of several degrees of freedom."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import ParameterError, Parameters, parameter, per_name
from daidalos.control.contracts import Controller, Service, Subscription
from daidalos.control.interfaces import Interfaces, interface_names
from daidalos.control.pid import Gains, Pid
from daidalos.samples.controllers import (
    Answer,
    Asked,
    DofCommand,
    DofSample,
    DofState,
    Switched,
)
from daidalos.samples.sensors import Sample

_KINDS = ("position", "velocity", "acceleration", "effort")


@dataclass(frozen=True)
class DofGains(Gains):
    """Gains of one degree of freedom."""

    feedforward_gain: float = parameter(
        0.0, "Factor of the reference, or of its rate where that is one, in the command."
    )
    angle_wraparound: bool = parameter(False, "Whether it turns without end, so that errors are at most half a turn.")
    save_i_term: bool = parameter(True, "Whether the integral outlives a stop.")


@dataclass(frozen=True)
class PidParameters(Parameters):
    """Parameters of the PID controller, as ROS names them."""

    dof_names: tuple[str, ...] = parameter(
        (), "Degrees of freedom that are commanded.", not_empty=True, unique=True, read_only=True
    )
    reference_and_state_dof_names: tuple[str, ...] = parameter(
        (), "Degrees of freedom that are measured; empty for dof_names.", unique=True, read_only=True
    )
    command_interface: str = parameter("", "Interface that is commanded.", not_empty=True, read_only=True)
    reference_and_state_interfaces: tuple[str, ...] = parameter(
        (), "Interface of the measured value, and of its derivative where that is measured.", choices=_KINDS,
        not_empty=True, read_only=True,
    )  # fmt: skip
    use_external_measured_states: bool = parameter(
        False, "Whether measurements come from ~/measured_state.", read_only=True
    )
    gains: dict[str, DofGains] = per_name(DofGains, by="dof_names")
    enable_feedforward: bool = parameter(False, "Whether feedforward is on when the controller starts.")

    def check(self) -> None:
        """Check the lengths of the lists."""
        measured = len(self.reference_and_state_dof_names)
        if measured not in (0, len(self.dof_names)):
            wanted = len(self.dof_names)
            raise ParameterError("reference_and_state_dof_names", f"has {measured} elements, dof_names has {wanted}")
        if len(self.reference_and_state_interfaces) > 2:
            raise ParameterError("reference_and_state_interfaces", "may have two elements: a value and its derivative")


class PidController(Controller):
    """Controller with a PID loop for each degree of freedom."""

    names = ("pid_controller/PidController",)
    Parameters = PidParameters
    chainable = True
    parameters: PidParameters

    def configure(self) -> None:
        """Set the interface names."""
        p = self.parameters
        self._dofs = p.reference_and_state_dof_names or p.dof_names
        names = interface_names(self._dofs, p.reference_and_state_interfaces)
        self.command_names = interface_names(p.dof_names, (p.command_interface,))
        self.state_names = () if p.use_external_measured_states else names
        self.references, self.exported = Interfaces(names), Interfaces(names)
        self._count = len(p.dof_names)
        self._with_rates = len(p.reference_and_state_interfaces) == 2
        self._feedforward = p.enable_feedforward
        self._pid = Pid([p.gains[name] for name in p.dof_names])
        self._take_gains()

    def reconfigure(self, parameters: PidParameters) -> None:
        """Apply changed gains."""
        super().reconfigure(parameters)
        self._pid.set_gains([parameters.gains[name] for name in parameters.dof_names])
        self._take_gains()

    def _take_gains(self) -> None:
        gains = [self.parameters.gains[name] for name in self.parameters.dof_names]
        self._endless = np.array([one.angle_wraparound for one in gains])
        self._forward = np.array([one.feedforward_gain for one in gains])

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """State of the loops."""
        return {"~/controller_state": DofSample}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """References, and measurements if these are received on a topic."""
        topics = {"~/reference": Subscription(DofCommand, self._take_reference)}
        if self.parameters.use_external_measured_states:
            topics["~/measured_state"] = Subscription(DofCommand, self._take_measured)
        return topics

    @property
    def services(self) -> Mapping[str, Service]:
        """Switch of feedforward, and reset of the integrals."""
        return {
            "~/set_feedforward_control": Service(Switched, self._set_feedforward),
            "~/reset_integral": Service(Asked, self._reset),
        }

    def _set_feedforward(self, question: Switched) -> Answer:
        self._feedforward = question.on
        return Answer(success=True)

    def _reset(self, question: Asked) -> Answer:
        self._pid.reset()
        return Answer(success=True)

    def _take_reference(self, command: DofCommand) -> None:
        self._take(command, self._received)

    def _take_measured(self, command: DofCommand) -> None:
        self._take(command, self._measured)

    def _take(self, command: DofCommand, into: np.ndarray) -> None:
        names = command.names or self._dofs
        unknown = next((name for name in names if name not in self._dofs), "")
        if unknown or len(command.values) != len(names):
            problem = f"'{unknown}' is not one of {', '.join(self._dofs)}" if unknown else "values and names differ"
            self.context.warn(f"command not accepted: {problem}")
            return
        for place, name in enumerate(names):
            row = self._dofs.index(name)
            into[0, row] = command.values[place]
            if self._with_rates:
                into[1, row] = command.rates[place] if len(command.rates) == len(names) else 0.0

    def activate(self, now_ns: int) -> None:
        """Clear the references until the first one is received."""
        shape = (1 + self._with_rates, self._count)
        self._received, self._measured = np.full(shape, np.nan), np.full(shape, np.nan)
        self.references.values[:] = np.nan
        keeps = all(one.save_i_term for one in self.parameters.gains.values())
        self._pid.reset(keep_integral=keeps)

    def take_references(self, now_ns: int, period: float) -> None:
        """Apply the last received references."""
        known = ~np.isnan(self._received.ravel())
        self.references.values[known] = self._received.ravel()[known]

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Update the loops whose reference and measurement are known."""
        wanted = self.references.values.reshape(-1, self._count)
        external = self.parameters.use_external_measured_states
        measured = self._measured if external else self.states.read().reshape(-1, self._count)
        self.exported.values[:] = measured.ravel()
        error = wanted[0] - measured[0]
        error = np.where(self._endless, np.remainder(error + math.pi, 2 * math.pi) - math.pi, error)
        known = ~np.isnan(error)
        if not known.any():
            return
        rate = np.nan_to_num(wanted[1] - measured[1]) if self._with_rates else None
        output = self._pid.update(np.where(known, error, 0.0), period, rate)
        if self._feedforward:
            output = output + self._forward * np.nan_to_num(wanted[-1])
        self.commands.write(np.where(known, output, self.commands.read()))
        if self.context.has_subscribers("~/controller_state"):
            yield self._sample(now_ns, wanted, measured, error, rate, period, output)

    def _sample(
        self,
        now_ns: int,
        wanted: np.ndarray,
        measured: np.ndarray,
        error: np.ndarray,
        rate: np.ndarray | None,
        period: float,
        output: np.ndarray,
    ) -> DofSample:
        rates = self._pid.error_rate if rate is None else rate
        speeds = measured[1] if self._with_rates else np.zeros(self._count)
        rows = zip(self._dofs, wanted[0], measured[0], speeds, error, rates, output, strict=True)
        return DofSample(
            stamp_ns=now_ns,
            topic="~/controller_state",
            frame_id="",
            dofs=tuple(
                DofState(name, *(float(one) for one in (*values[:-1], period, values[-1]))) for name, *values in rows
            ),
        )
