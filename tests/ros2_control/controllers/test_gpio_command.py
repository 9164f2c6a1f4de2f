"""The GPIO controller."""

from typing import Any

import numpy as np
import pytest
from control_robots import PERIOD_NS, alone, arm, cycle, from_values, manager

from daidalos.common.parameters import ParameterError
from daidalos.control.contracts import ControllerContext
from daidalos.samples.controllers import InterfaceGroupsCommand

TYPE = "gpio_controllers/GpioCommandController"
GPIOS = """<gpio name="flange"><command_interface name="out"/><command_interface name="vacuum"/>
  <state_interface name="out"/><state_interface name="in"><param name="initial_value">0.5</param></state_interface>
  </gpio><gpio name="panel"><state_interface name="lamp"/></gpio>"""
SEVERAL: dict[str, Any] = {
    "gpios": ["flange", "panel"],
    "command_interfaces": {"flange": {"interfaces": ["out", "vacuum"]}},
    "state_interfaces": {"flange": {"interfaces": ["in"]}, "panel": {"interfaces": ["lamp"]}},
}


def command(**groups: dict[str, float]) -> InterfaceGroupsCommand:
    return InterfaceGroupsCommand(
        tuple(groups), tuple((tuple(values), tuple(values.values())) for values in groups.values())
    )


def test_named_interfaces_are_commanded_and_told() -> None:
    controller, commands, states = alone(TYPE, **SEVERAL)
    assert commands.names == ("flange/out", "flange/vacuum")
    states.values[:] = [0.25, 1.0]
    said = cycle(controller, PERIOD_NS)
    assert np.isnan(commands.values).all()
    assert said[0].topic == "~/gpio_states"
    assert said[0].groups == {"flange": {"in": 0.25}, "panel": {"lamp": 1.0}}
    take = controller.subscriptions["~/commands"].take
    take(command(flange={"vacuum": 1.0}))
    cycle(controller, 2 * PERIOD_NS)
    assert np.array_equal(commands.values, [np.nan, 1.0], equal_nan=True)
    take(command(flange={"out": 3.0}))
    cycle(controller, 3 * PERIOD_NS)
    assert commands.values == pytest.approx([3.0, 1.0])


def test_wrong_commands_are_told_and_not_executed() -> None:
    warnings: list[str] = []
    controller, commands, _ = alone(TYPE, None, {"warn": warnings.append}, **SEVERAL)
    take = controller.subscriptions["~/commands"].take
    take(InterfaceGroupsCommand(("flange",), ((("out", "vacuum"), (1.0,)),)))
    take(InterfaceGroupsCommand(("flange", "panel"), ((("out",), (1.0,)),)))
    take(command(flange={"heater": 1.0}))
    cycle(controller, PERIOD_NS)
    assert np.isnan(commands.values).all()
    assert [line.partition(";")[0] for line in warnings] == [
        "command of 'flange' has 2 interfaces and 1 values",
        "command has 2 groups and values of 1",
        "'flange/heater' is not commanded by 'it'",
    ]


def test_a_command_from_before_the_activation_is_forgotten() -> None:
    controller, commands, _ = alone(TYPE, **SEVERAL)
    controller.subscriptions["~/commands"].take(command(flange={"out": 3.0}))
    controller.deactivate()
    controller.activate(0)
    cycle(controller, PERIOD_NS)
    assert np.isnan(commands.values).all()


def test_without_state_interfaces_all_of_the_hardware_are_told() -> None:
    control = manager(arm(extra=GPIOS))
    values = {"gpios": ["flange"], "command_interfaces": {"flange": {"interfaces": ["out"]}}}
    control.load("gpios", TYPE, from_values(**values), ControllerContext("gpios"))
    control.configure("gpios")
    control.switch(["gpios"])
    control.update(PERIOD_NS)
    control.controllers["gpios"].running.subscriptions["~/commands"].take(command(flange={"out": 2.0}))
    control.update(2 * PERIOD_NS)
    said = control.update(3 * PERIOD_NS)
    assert [sample.groups for _, sample in said] == [{"flange": {"out": 2.0, "in": 0.5}}]


def test_gpios_without_any_interface_are_refused() -> None:
    with pytest.raises(ParameterError, match="'gpios' names panel, of which there are no"):
        alone(TYPE, gpios=["panel"])
