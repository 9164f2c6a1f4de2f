"""The controller manager: lifecycles, the loop, chains, failures."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from control_robots import arm, from_values, manager

from daidalos.common.extensions import UnknownExtension
from daidalos.common.parameters import ParameterError, Parameters, parameter
from daidalos.control.contracts import Controller, ControllerContext, Hardware
from daidalos.control.errors import HardwareError, StateError, SwitchError, UnknownError
from daidalos.control.interfaces import Interfaces
from daidalos.control.manager import ControllerManager
from daidalos.control.switching import Strictness
from daidalos.samples.controllers import ValuesCommand
from daidalos.samples.sensors import Sample

FORWARD = "forward_command_controller/ForwardCommandController"
PLACE = __name__


@dataclass(frozen=True)
class WatchParameters(Parameters):
    command: str = parameter("", "Interface that is commanded.")
    state: str = parameter("elbow/position", "Interface that is measured.")
    fail_at_ns: int = parameter(0, "When to fail.", unit="ns")


class Watch(Controller):
    """Notes its cycles; passes references on; may fail."""

    Parameters = WatchParameters
    chainable = True

    def configure(self) -> None:
        self.command_names = (self.parameters.command,) if self.parameters.command else ()
        self.state_names = (self.parameters.state,) if self.parameters.state else ()
        self.references = Interfaces(["x"])
        self.exported = Interfaces(["seen"])
        self.cycles: list[tuple[int, float]] = []
        self.value = 0.0

    def take_references(self, now_ns: int, period: float) -> None:
        self.references["x"] = self.value

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        self.cycles.append((now_ns, period))
        if 0 < self.parameters.fail_at_ns <= now_ns:
            raise ZeroDivisionError("nothing to divide by")
        self.commands.write(self.references.values)
        self.exported["seen"] = self.states.read()[0] if self.state_names else 0.0
        return (Sample(now_ns, "~/seen", ""),)


class Fragile(Hardware):
    """Hardware that fails when it is told to."""

    fail_in = ""

    def configure(self) -> None:
        self.states.values[:] = 0.0
        self._maybe("configure")

    def read(self, now_ns: int, period: float) -> None:
        self._maybe("read")

    def prepare_switch(self, start: Any, stop: Any) -> None:
        self._maybe("prepare_switch")

    def _maybe(self, place: str) -> None:
        if type(self).fail_in == place:
            raise HardwareError(f"broken in {place}")


@pytest.fixture
def fragile() -> Iterable[None]:
    yield
    Fragile.fail_in = ""


def loaded(
    one: ControllerManager, name: str, type_name: str = f"{PLACE}.Watch", rate: float = 0.0, **values: Any
) -> Any:
    one.load(name, type_name, from_values(**values), ControllerContext(name, update_rate=rate))
    one.configure(name)
    return one.controllers[name].controller


def run(one: ControllerManager, seconds: float) -> list[tuple[str, Sample]]:
    said = []
    for _ in range(round(seconds * one.update_rate)):
        said += one.update(one.time_ns + round(1e9 / one.update_rate))
    return said


def test_a_controller_goes_through_its_states() -> None:
    one = manager(arm())
    one.load("it", FORWARD, from_values(joints=["elbow"], interface_name="position"))
    assert one.controllers["it"].state == "unconfigured"
    with pytest.raises(SwitchError, match="is unconfigured"):
        one.switch(["it"])
    one.configure("it")
    assert one.controllers["it"].state == "inactive"
    one.switch(["it"])
    assert one.controllers["it"].state == "active"
    assert one.claimed("elbow/position") == "it"
    for forbidden in (one.cleanup, one.unload, one.configure):
        with pytest.raises(StateError, match="'it' is active"):
            forbidden("it")
    one.switch(stop=["it"])
    one.cleanup("it")
    assert one.controllers["it"].state == "unconfigured"
    one.unload("it")
    assert not one.controllers


def test_what_is_not_there_or_wrong_is_named() -> None:
    one = manager(arm())
    with pytest.raises(
        UnknownExtension, match="no controller 'forward_command_controller/ForwardComandController'; did"
    ):
        one.load("it", "forward_command_controller/ForwardComandController", from_values())
    with pytest.raises(UnknownError, match="there is no controller 'it'; there are: none"):
        one.configure("it")
    one.load("it", FORWARD, from_values(joints=["elbow"]))
    with pytest.raises(ParameterError, match="'interface_name' must not be empty"):
        one.configure("it")
    assert one.controllers["it"].state == "unconfigured"
    with pytest.raises(StateError, match="'it' is loaded already"):
        one.load("it", FORWARD, from_values())


@pytest.mark.parametrize(("rate", "cycles"), [(0.0, 1000), (1000.0, 1000), (500.0, 500), (300.0, 300), (5000.0, 1000)])
def test_rates_hold_exactly(rate: float, cycles: int) -> None:
    one = manager(arm(), 1000.0)
    watch = loaded(one, "it", rate=rate)
    one.switch(["it"])
    said = run(one, 1.0)
    assert len(watch.cycles) == len(said) == cycles
    times = np.array([time for time, _ in watch.cycles])
    period = 1e9 / min(rate or 1000.0, 1000.0)
    assert np.all(np.abs(times - times[0] - np.arange(cycles) * period) < 1_000_001)
    assert [elapsed for _, elapsed in watch.cycles[1:]] == pytest.approx(np.diff(times) * 1e-9)


def test_a_chain_passes_values_within_one_cycle() -> None:
    one = manager(arm())
    # Loaded in an order that is not the one in which they have to run.
    low = loaded(one, "low", command="elbow/position")
    top = loaded(one, "top", command="middle/x", state="")
    loaded(one, "middle", command="low/x")
    reader = loaded(one, "reader", state="low/seen")
    one.switch(["top", "middle", "low", "reader"])
    top.value = 0.25
    run(one, 0.01)
    assert one.components["arm"].hardware.commands["elbow/position"] == 0.25
    assert low.chained
    assert not top.chained
    run(one, 0.01)
    assert reader.states.read()[0] == 0.25
    assert one.chained_to("top") == {"middle": ("middle/x",)}
    one.switch(stop=["top"])
    assert not one.controllers["middle"].running.chained


def test_the_last_command_is_gone_when_nobody_commands() -> None:
    one = manager(arm())
    loaded(one, "it", command="elbow/position").value = 0.5
    one.switch(["it"])
    run(one, 0.02)
    one.switch(stop=["it"])
    assert np.isnan(one.components["arm"].hardware.commands["elbow/position"])
    run(one, 0.02)
    assert one.components["arm"].hardware.states["elbow/position"] == 0.5


def test_a_failing_controller_is_stopped_with_those_above_and_its_fallback_starts() -> None:
    log: list[str] = []
    one = manager(arm(), log=log.append)
    loaded(one, "low", command="elbow/position", fail_at_ns=30_000_000)
    loaded(one, "top", command="low/x")
    other = loaded(one, "other")
    loaded(one, "spare", command="elbow/position")
    one.controllers["low"].fallbacks = ("spare",)
    one.switch(["low", "top", "other"])
    run(one, 0.05)
    assert {name: c.state for name, c in one.controllers.items()} == {
        "low": "inactive",
        "top": "inactive",
        "other": "active",
        "spare": "active",
    }
    assert len(other.cycles) == 5
    assert "controller 'low' failed and is stopped: nothing to divide by" in log


def test_a_failing_driver_takes_its_controllers_down(fragile: None) -> None:
    log: list[str] = []
    one = manager(arm(f"{PLACE}.Fragile"), log=log.append)
    loaded(one, "it")
    one.switch(["it"])
    run(one, 0.02)
    Fragile.fail_in = "read"
    run(one, 0.02)
    assert one.components["arm"].state == "unconfigured"
    assert one.controllers["it"].state == "inactive"
    assert "hardware 'arm' failed: broken in read" in log
    with pytest.raises(SwitchError, match="needs elbow/position: hardware 'arm' is unconfigured"):
        one.switch(["it"])
    Fragile.fail_in = ""
    one.set_component_state("arm", "active")
    one.switch(["it"])
    assert one.controllers["it"].state == "active"


def test_hardware_may_refuse_a_switch(fragile: None) -> None:
    one = manager(arm(f"{PLACE}.Fragile"))
    loaded(one, "it", command="elbow/position")
    Fragile.fail_in = "prepare_switch"
    with pytest.raises(SwitchError, match="hardware 'arm' refuses: broken in prepare_switch"):
        one.switch(["it"])
    assert one.controllers["it"].state == "inactive"


def test_hardware_that_can_not_start_is_said_and_stays_unconfigured(fragile: None) -> None:
    log: list[str] = []
    Fragile.fail_in = "configure"
    one = manager(arm(f"{PLACE}.Fragile"), log=log.append)
    assert one.components["arm"].state == "unconfigured"
    assert log == ["hardware 'arm' cannot be made active: broken in configure"]


def test_hardware_states_say_what_can_be_used() -> None:
    one = manager(arm(), initial_states={"arm": "inactive"})
    loaded(one, "reads")
    loaded(one, "writes", command="elbow/position")
    one.switch(["reads"])
    with pytest.raises(SwitchError, match="hardware 'arm' is inactive"):
        one.switch(["writes"])
    one.set_component_state("arm", "active")
    one.switch(["writes"])
    one.set_component_state("arm", "inactive")
    assert [c.state for c in one.controllers.values()] == ["active", "inactive"]
    one.set_component_state("arm", "unconfigured")
    assert one.controllers["reads"].state == "inactive"
    with pytest.raises(UnknownError, match="no hardware 'leg'; there are: arm"):
        one.set_component_state("leg", "active")


def test_time_that_goes_back_starts_controllers_anew() -> None:
    one = manager(arm())
    watch = loaded(one, "it", rate=50.0)
    one.switch(["it"])
    run(one, 1.0)
    watch.cycles.clear()
    one.update(10_000_000)
    run(one, 0.1)
    assert watch.cycles[0][0] == 10_000_000
    assert len(watch.cycles) == 6
    assert one.controllers["it"].state == "active"


def test_best_effort_switches_what_it_can() -> None:
    one = manager(arm())
    loaded(one, "a", command="elbow/position")
    loaded(one, "b", command="elbow/position")
    done = one.switch(["a", "b"], strictness=Strictness.BEST_EFFORT)
    assert done.start == ("a",)
    assert "which 'a' holds" in done.left_out[0]


def test_shutdown_stops_everything() -> None:
    one = manager(arm())
    loaded(one, "it")
    one.switch(["it"])
    with pytest.raises(StateError, match="controllers are active: it"):
        one.unload_all()
    one.shutdown()
    assert not one.controllers
    assert one.components["arm"].state == "finalized"


def test_commands_reach_the_hardware() -> None:
    one = manager(arm())
    forward = loaded(one, "it", FORWARD, joints=["wrist", "elbow"], interface_name="position")
    one.switch(["it"])
    forward.subscriptions["~/commands"].take(ValuesCommand(np.array([2.0, 1.0])))
    run(one, 0.04)
    states = one.components["arm"].hardware.states
    assert (states["wrist/position"], states["elbow/position"]) == (2.0, 1.0)
