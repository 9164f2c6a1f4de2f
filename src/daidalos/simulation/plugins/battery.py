"""Battery: its voltage falls with the charge, and its charge with the load."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import partial

from daidalos.description.link import Plugin as Description
from daidalos.samples.commands import SignalCommand
from daidalos.samples.endpoint import Subscription
from daidalos.samples.sensors import BatterySample, Sample
from daidalos.simulation.contracts import ComponentContext, Plugin, Switch
from daidalos.simulation.topics import absolute_topic

_HOUR = 3600.0
_PERIOD = 0.1


@dataclass
class Charge:
    """Charge [A h], smoothed current [A], flags of load and charger, and time of the last update."""

    charge: float
    current: float
    draining: bool
    charging: bool = False
    stamp_ns: int = -1


class LinearBattery(Plugin):
    """gz's LinearBatteryPlugin: v = e0 + e1 (1 - q / c) - r i, with i = load / v."""

    names = ("gz-sim-linearbatteryplugin-system", "gz-sim-linear-battery-plugin-system")
    sample = BatterySample
    unused = ("fix_issue_225", "recharge_by_topic", "soc_threshold")
    state: Charge
    period = _PERIOD

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(description, context)
        element = description.element
        name = element.text_of("battery_name")
        if not name:
            raise element.error("<battery_name> is needed")
        self.capacity = element.number_of("capacity", default=1.0)
        if self.capacity <= 0:
            raise element.error(f"<capacity> should be positive, got {self.capacity:g}")
        self.full = element.number_of(
            "open_circuit_voltage_constant_coef", default=element.number_of("voltage", default=12.0)
        )
        self.slope = element.number_of("open_circuit_voltage_linear_coef", default=0.0)
        self.resistance = element.number_of("resistance", default=0.0)
        self.tau = element.number_of("smooth_current_tau", default=1.0)
        self.load = element.number_of("power_load", default=0.0)
        self.initial = min(element.number_of("initial_charge", default=self.capacity), self.capacity)
        self.starts = element.flag_of("start_draining", default=True)
        self.charging_hours = element.number_of("charging_time", default=0.0)
        self.recharges = element.flag_of("enable_recharge", default=False) and self.charging_hours > 0
        base = f"/model/{context.model_name}/battery/{name}"
        self.topic = absolute_topic(f"{base}/state", context.namespace)
        self._services = tuple(
            absolute_topic(f"{base}/recharge/{word}", context.namespace) for word in ("start", "stop")
        )
        self._starters, self._stoppers = (
            tuple(absolute_topic(child.text.strip(), context.namespace) for child in element.all(tag))
            for tag in ("power_draining_topic", "stop_power_draining_topic")
        )
        if self._starters and element.first("start_draining") is None:
            self.starts = False

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topics that switch the load on and off."""
        return {
            topic: Subscription(SignalCommand, partial(self._drain, draining))
            for topics, draining in ((self._starters, True), (self._stoppers, False))
            for topic in topics
        }

    @property
    def switches(self) -> Mapping[str, Switch]:
        """Service of the charger, if there is one."""
        if not self.recharges:
            return {}
        return {name: Switch(self._recharge, on) for name, on in zip(self._services, (True, False), strict=True)}

    def start(self) -> Charge:
        """Return the initial charge."""
        return Charge(self.initial, 0.0, self.starts)

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Integrate the current since the last update."""
        state = self.state
        elapsed = (now_ns - state.stamp_ns) * 1e-9 if state.stamp_ns >= 0 else 0.0
        state.stamp_ns = now_ns
        voltage = self._voltage(state)
        load = self.load / voltage if state.draining and state.charge > 0 and voltage > 0 else 0.0
        supply = self.capacity / self.charging_hours if state.charging else 0.0
        share = 1.0 - math.exp(-elapsed / self.tau) if self.tau > 0 else 1.0
        state.current += (supply - load - state.current) * share
        state.charge = min(max(state.charge + state.current * elapsed / _HOUR, 0.0), self.capacity)
        yield BatterySample(now_ns, self.topic, "", self._voltage(state), state.current, state.charge, self.capacity)

    def _voltage(self, state: Charge) -> float:
        return self.full + self.slope * (1.0 - state.charge / self.capacity) + self.resistance * state.current

    def _drain(self, draining: bool, command: SignalCommand) -> None:
        self.state.draining = draining

    def _recharge(self, on: bool) -> None:
        self.state.charging = on
