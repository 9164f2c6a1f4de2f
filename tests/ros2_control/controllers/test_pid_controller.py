"""The PID controller."""

import math
from typing import Any

import numpy as np
import pytest
from control_robots import PERIOD_NS, alone, cycle

from daidalos.common.parameters import ParameterError
from daidalos.samples.controllers import Asked, DofCommand, Switched

TYPE = "pid_controller/PidController"


def rig(**values: Any) -> Any:
    given: dict[str, Any] = {
        "dof_names": ["a", "b"],
        "command_interface": "effort",
        "reference_and_state_interfaces": ["position"],
    }
    return alone(TYPE, **(given | values))


def send(controller: Any, *values: float, names: tuple[str, ...] = (), rates: tuple[float, ...] = ()) -> None:
    controller.subscriptions["~/reference"].take(DofCommand(names, np.array(values), np.array(rates)))


def test_each_loop_has_its_gains() -> None:
    controller, commands, states = rig(gains={"a": {"p": 2.0}, "b": {"p": 1.0, "i": 10.0}})
    assert cycle(controller, PERIOD_NS) == []
    assert np.isnan(commands.values).all()
    send(controller, 1.0, 2.0)
    states.values[:] = [0.5, 0.0]
    said = cycle(controller, 2 * PERIOD_NS)
    assert commands.values == pytest.approx([1.0, 2.0 + 10.0 * 2.0 * 0.01])
    dof = said[0].dofs[1]
    assert (dof.name, dof.reference, dof.feedback, dof.error) == ("b", 2.0, 0.0, 2.0)
    assert dof.output == pytest.approx(2.2)
    assert dof.time_step == pytest.approx(0.01)


def test_names_and_strangers() -> None:
    warnings: list[str] = []
    controller, commands, _ = alone(
        TYPE,
        None,
        {"warn": warnings.append},
        dof_names=["a", "b"],
        command_interface="effort",
        reference_and_state_interfaces=["position"],
        gains={"b": {"p": 1.0}},
    )
    send(controller, 3.0, names=("b",))
    cycle(controller, PERIOD_NS)
    assert commands.values[1] == 3.0
    assert math.isnan(commands.values[0])
    send(controller, 3.0, names=("c",))
    send(controller, 3.0)
    assert len(warnings) == 2
    assert "'c' is not one of a, b" in warnings[0]


def test_a_derivative_is_used_where_it_is_measured() -> None:
    controller, commands, states = rig(
        reference_and_state_interfaces=["position", "velocity"], gains={"a": {"p": 1.0, "d": 0.5}}
    )
    assert states.names == ("a/position", "b/position", "a/velocity", "b/velocity")
    send(controller, 1.0, 0.0, rates=(2.0, 0.0))
    states["a/velocity"] = 0.5
    cycle(controller, PERIOD_NS)
    assert commands.values[0] == pytest.approx(1.0 + 0.5 * 1.5)


def test_feedforward_is_switched_on() -> None:
    controller, commands, states = rig(gains={"a": {"p": 1.0, "feedforward_gain": 0.1}})
    send(controller, 5.0, 0.0)
    states.values[:] = [5.0, 0.0]
    cycle(controller, PERIOD_NS)
    assert commands.values[0] == 0.0
    assert controller.services["~/set_feedforward_control"].answer(Switched(on=True)).success
    cycle(controller, 2 * PERIOD_NS)
    assert commands.values[0] == pytest.approx(0.5)


def test_the_integral_can_be_reset_and_survives_a_stop() -> None:
    controller, commands, _ = rig(gains={"a": {"i": 1.0}})
    send(controller, 1.0, 0.0)
    for step in range(10):
        cycle(controller, (step + 1) * PERIOD_NS)
    assert commands.values[0] == pytest.approx(0.1)
    controller.activate(0)
    send(controller, 1.0, 0.0)
    cycle(controller, PERIOD_NS)
    assert commands.values[0] == pytest.approx(0.11)
    controller.services["~/reset_integral"].answer(Asked())
    cycle(controller, 2 * PERIOD_NS)
    assert commands.values[0] == pytest.approx(0.01)


def test_angles_take_the_short_way() -> None:
    controller, commands, states = rig(gains={"a": {"p": 1.0, "angle_wraparound": True}, "b": {"p": 1.0}})
    send(controller, 3.0, 3.0)
    states.values[:] = -3.0
    cycle(controller, PERIOD_NS)
    assert commands.values == pytest.approx([6.0 - 2 * math.pi, 6.0])


def test_measurements_may_come_from_outside() -> None:
    controller, commands, states = rig(use_external_measured_states=True, gains={"a": {"p": 1.0}, "b": {"p": 1.0}})
    assert states.names == ()
    send(controller, 1.0, 1.0)
    assert cycle(controller, PERIOD_NS) == []
    controller.subscriptions["~/measured_state"].take(DofCommand((), np.array([0.25, 0.5]), np.zeros(0)))
    cycle(controller, 2 * PERIOD_NS)
    assert commands.values == pytest.approx([0.75, 0.5])


def test_measured_and_commanded_names_may_differ() -> None:
    controller, commands, states = rig(reference_and_state_dof_names=["x", "y"])
    assert commands.names == ("a/effort", "b/effort")
    assert states.names == controller.references.names == ("x/position", "y/position")
    with pytest.raises(ParameterError, match="has 1 elements, dof_names has 2"):
        rig(reference_and_state_dof_names=["x"])


def test_gains_can_change_while_it_runs() -> None:
    from dataclasses import replace

    controller, commands, _ = rig(gains={"a": {"p": 1.0}})
    send(controller, 1.0, 0.0)
    cycle(controller, PERIOD_NS)
    gains = {**controller.parameters.gains, "a": replace(controller.parameters.gains["a"], p=4.0)}
    controller.reconfigure(replace(controller.parameters, gains=gains))
    cycle(controller, 2 * PERIOD_NS)
    assert commands.values[0] == pytest.approx(4.0)
