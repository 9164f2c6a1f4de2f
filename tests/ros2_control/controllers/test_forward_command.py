"""Controllers that forward commands."""

import numpy as np
import pytest
from control_robots import PERIOD_NS, alone, cycle

from daidalos.samples.controllers import ValuesCommand

KINDS = {
    "forward_command_controller/ForwardCommandController": (
        {"joints": ["a", "b"], "interface_name": "velocity"},
        ("a/velocity", "b/velocity"),
    ),
    "forward_command_controller/MultiInterfaceForwardCommandController": (
        {"joint": "a", "interface_names": ["velocity", "effort"]},
        ("a/velocity", "a/effort"),
    ),
    "passthrough_controller/PassthroughController": (
        {"interfaces": ["a/position", "below/b/position"]},
        ("a/position", "below/b/position"),
    ),
    "position_controllers/JointGroupPositionController": ({"joints": ["a", "b"]}, ("a/position", "b/position")),
    "velocity_controllers/JointGroupVelocityController": ({"joints": ["a", "b"]}, ("a/velocity", "b/velocity")),
    "effort_controllers/JointGroupEffortController": ({"joints": ["a", "b"]}, ("a/effort", "b/effort")),
}


@pytest.mark.parametrize("type_name", KINDS)
def test_commands_go_through(type_name: str) -> None:
    values, names = KINDS[type_name]
    warnings: list[str] = []
    controller, commands, _ = alone(type_name, None, {"warn": warnings.append}, **values)
    assert commands.names == controller.references.names == names
    cycle(controller, PERIOD_NS)
    assert np.isnan(commands.values).all()
    take = controller.subscriptions["~/commands"].take
    take(ValuesCommand(np.array([1.0, -2.0])))
    cycle(controller, 2 * PERIOD_NS)
    assert commands.values == pytest.approx([1.0, -2.0])
    take(ValuesCommand(np.array([1.0])))
    assert warnings == ["command has 1 values instead of 2; it is not executed"]
    controller.deactivate()
    stands = type_name.startswith(("velocity", "effort"))
    assert commands.values == pytest.approx([0.0, 0.0] if stands else [1.0, -2.0])


def test_another_controller_may_command_some() -> None:
    values, _ = KINDS["position_controllers/JointGroupPositionController"]
    controller, commands, _ = alone("position_controllers/JointGroupPositionController", **values)
    controller.chained = True
    commands.values[:] = [5.0, 6.0]
    controller.references["b/position"] = 7.0
    cycle(controller, PERIOD_NS)
    assert commands.values == pytest.approx([5.0, 7.0])
