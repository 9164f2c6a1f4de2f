"""Admittance, against the differential equation of a mass on a spring."""

from typing import Any

import numpy as np
import pytest
from control_robots import PERIOD_NS, alone, cycle
from scipy.integrate import solve_ivp

from daidalos.common.parameters import ParameterError
from daidalos.control.errors import ControlError
from daidalos.description import urdf
from daidalos.samples.controllers import AdmittanceSample, TrajectoryPoint

PERIOD = PERIOD_NS * 1e-9
GANTRY = urdf.parse("""<robot name="gantry"><link name="base"/><link name="x"/><link name="y"/><link name="tip"/>
  <joint name="jx" type="prismatic"><parent link="base"/><child link="x"/><axis xyz="1 0 0"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="jy" type="prismatic"><parent link="x"/><child link="y"/><axis xyz="0 1 0"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="jz" type="prismatic"><parent link="y"/><child link="tip"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint></robot>""")
MASS, RATIO, STIFFNESS = 2.0, 0.7, 50.0


def rig(robot: Any = GANTRY, **values: Any) -> Any:
    given: dict[str, Any] = {
        "joints": ["jx", "jy", "jz"],
        "command_interfaces": ["position", "velocity"],
        "state_interfaces": ["position"],
        "kinematics": {"base": "base", "tip": "tip", "alpha": 1e-9},
        "ft_sensor": {"name": "wrist", "frame": {"id": "tip"}, "filter_coefficient": 1.0},
        "control": {"frame": {"id": "tip"}},
        "fixed_world_frame": {"frame": {"id": "base"}},
        "gravity_compensation": {"frame": {"id": "tip"}},
        "admittance": {
            "selected_axes": [True, True, False, False, False, False],
            "mass": [MASS] * 6,
            "damping_ratio": [RATIO] * 6,
            "stiffness": [STIFFNESS] * 6,
            "joint_damping": 0.0,
        },
    }
    return alone("admittance_controller/AdmittanceController", robot, **(given | values))


def run(parts: Any, cycles: int, start: int = 0) -> tuple[np.ndarray, Any]:
    controller, commands, states = parts
    rows, said = [], []
    for step in range(cycles):
        said = cycle(controller, (start + step + 1) * PERIOD_NS)
        states.values[:3] = commands.values[:3]
        rows.append(commands.values.copy())
    return np.array(rows), said


@pytest.mark.slow
def test_it_yields_like_a_mass_on_a_spring_and_a_damper() -> None:
    parts = rig()
    parts[2]["wrist/force.x"] = 10.0
    rows, said = run(parts, 300)
    damping = 2 * RATIO * np.sqrt(MASS * STIFFNESS)
    exact = solve_ivp(
        lambda _, state: [state[1], (10.0 - damping * state[1] - STIFFNESS * state[0]) / MASS],
        (0.0, 3.0),
        [0.0, 0.0],
        t_eval=np.arange(1, 301) * PERIOD,
        rtol=1e-8,
    )
    assert rows[:, 0] == pytest.approx(exact.y[0], abs=0.006)
    assert rows[-1, 0] == pytest.approx(10.0 / STIFFNESS, rel=1e-3)
    state = next(one for one in said if isinstance(one, AdmittanceSample))
    assert state.wrench[0] == 10.0
    assert state.damping == pytest.approx(damping)


def test_axes_that_are_not_selected_stay() -> None:
    parts = rig()
    parts[2]["wrist/force.z"] = 10.0
    rows, _ = run(parts, 100)
    assert rows[:, 2] == pytest.approx(0.0)


@pytest.mark.slow
def test_references_are_followed_and_forces_push_away_from_them() -> None:
    parts = rig()
    take = parts[0].subscriptions["~/joint_references"].take
    take(TrajectoryPoint(0.0, positions=np.array([0.5, -0.5, 0.2]), velocities=np.array([0.1, 0.0, 0.0])))
    rows, _ = run(parts, 10)
    assert rows[-1] == pytest.approx([0.5, -0.5, 0.2, 0.1, 0.0, 0.0])
    parts[2]["wrist/force.y"] = -5.0
    rows, _ = run(parts, 600, 10)
    assert rows[-1, :3] == pytest.approx([0.5, -0.6, 0.2], abs=1e-4)


def test_the_weight_of_the_tool_is_no_force() -> None:
    parts = rig(gravity_compensation={"frame": {"id": "tip"}, "CoG": {"pos": [0.1, 0.0, 0.0], "force": 9.8}})
    parts[2].values[3:] = [0.0, 0.0, -9.8, 0.0, 0.98, 0.0]
    _, said = run(parts, 3)
    state = next(one for one in said if isinstance(one, AdmittanceSample))
    assert state.wrench == pytest.approx(np.zeros(6), abs=1e-12)


def test_the_sensor_is_smoothed() -> None:
    parts = rig(ft_sensor={"name": "wrist", "frame": {"id": "tip"}, "filter_coefficient": 0.25})
    run(parts, 1)
    parts[2]["wrist/force.x"] = 8.0
    found = [run(parts, 1, step)[1][-1].wrench[0] for step in range(1, 4)]
    assert found == pytest.approx([8.0 * (1 - 0.75**k) for k in (1, 2, 3)])


def test_other_controllers_may_command_it() -> None:
    parts = rig()
    controller = parts[0]
    assert controller.references.names[:3] == ("jx/position", "jy/position", "jz/position")
    controller.chained = True
    controller.references["jx/position"] = 0.3
    rows, _ = run(parts, 2)
    assert rows[-1, 0] == pytest.approx(0.3)


def test_it_needs_a_description_and_sound_parameters() -> None:
    with pytest.raises(ControlError, match="description is needed"):
        rig(None)
    with pytest.raises(ParameterError, match=r"'admittance\.mass' must have 6 elements, got 0"):
        rig(admittance={})
    with pytest.raises(ControlError, match="no link 'hand'"):
        rig(control={"frame": {"id": "hand"}})
