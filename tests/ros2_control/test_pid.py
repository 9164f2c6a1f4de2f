"""PID control, against closed forms and python-free loops."""

import math

import numpy as np
import pytest
from scipy import integrate

from daidalos.common.parameters import ParameterError
from daidalos.control.pid import Gains, Pid


def run(gains: Gains, errors: list[float], period: float = 0.01) -> list[float]:
    pid = Pid([gains])
    return [float(pid.update(np.array([error]), period)[0]) for error in errors]


def test_each_part_is_what_it_is_called() -> None:
    errors = [0.3, 0.5, -0.2, 0.1]
    assert run(Gains(p=2.0), errors) == pytest.approx([2 * e for e in errors])
    assert run(Gains(i=4.0), errors, 0.1) == pytest.approx(list(np.cumsum(errors) * 0.1 * 4.0))
    assert run(Gains(d=0.5), errors, 0.1) == pytest.approx([0.0, *(np.diff(errors) / 0.1 * 0.5)])


def test_a_given_error_rate_outweighs_the_difference() -> None:
    pid = Pid([Gains(d=2.0)])
    assert pid.update(np.array([1.0]), 0.1, np.array([3.0])) == pytest.approx([6.0])


def test_loops_do_not_mix() -> None:
    both = Pid([Gains(p=1.0, i=1.0), Gains(p=3.0, d=1.0)])
    single = [Pid([Gains(p=1.0, i=1.0)]), Pid([Gains(p=3.0, d=1.0)])]
    for errors in np.random.default_rng(1).normal(size=(20, 2)):
        expected = [float(one.update(errors[k : k + 1], 0.01)[0]) for k, one in enumerate(single)]
        assert both.update(errors, 0.01) == pytest.approx(expected)


def test_clamps_hold_the_integral_and_the_output() -> None:
    pid = Pid([Gains(p=1.0, i=10.0, i_clamp_max=0.5, i_clamp_min=-0.1, u_clamp_max=1.2, u_clamp_min=-0.8)])
    for _ in range(100):
        output = pid.update(np.array([1.0]), 0.1)
    assert pid.i_term == pytest.approx([0.5])
    assert output == pytest.approx([1.2])
    for _ in range(100):
        output = pid.update(np.array([-1.0]), 0.1)
    assert pid.i_term == pytest.approx([-0.1])
    assert output == pytest.approx([-0.8])


def overshoot(strategy: str) -> float:
    """Return how far a slow plant, driven through a weak actuator, goes past a step."""
    pid = Pid([Gains(p=4.0, i=4.0, u_clamp_max=0.4, u_clamp_min=-0.4, antiwindup_strategy=strategy)])
    position, highest, period = 0.0, 0.0, 0.01
    for _ in range(3000):
        position += float(pid.update(np.array([1.0 - position]), period)[0]) * period
        highest = max(highest, position)
    assert position == pytest.approx(1.0, abs=0.02)
    return highest - 1.0


@pytest.mark.parametrize("strategy", ["conditional_integration", "back_calculation"])
def test_antiwindup_overshoots_far_less(strategy: str) -> None:
    assert overshoot("none") > 0.3
    assert overshoot(strategy) < 0.3 * overshoot("none")


@pytest.mark.slow
def test_back_calculation_follows_its_differential_equation() -> None:
    gains = Gains(i=2.0, u_clamp_max=1.0, antiwindup_strategy="back_calculation", tracking_time_constant=0.5)
    pid, period = Pid([gains]), 1e-4
    for _ in range(20_000):
        pid.update(np.array([3.0]), period)

    def rate(_: float, integral: list[float]) -> list[float]:
        return [2.0 * 3.0 + (min(integral[0], 1.0) - integral[0]) / 0.5]

    exact = integrate.solve_ivp(rate, (0.0, 2.0), [0.0], rtol=1e-9, max_step=0.01).y[0, -1]
    assert pid.i_term[0] == pytest.approx(exact, rel=1e-3)


def test_errors_in_the_deadband_are_not_integrated() -> None:
    assert run(Gains(i=1.0, error_deadband=0.2), [0.1, 0.1, 0.5], 1.0) == pytest.approx([0.0, 0.0, 0.5])


def test_reset_forgets_and_may_keep_the_integral() -> None:
    pid = Pid([Gains(i=1.0, d=1.0)])
    pid.update(np.array([1.0]), 1.0)
    pid.reset(keep_integral=True)
    assert pid.update(np.array([0.0]), 1.0) == pytest.approx([1.0])
    pid.reset()
    assert pid.update(np.array([0.0]), 1.0) == pytest.approx([0.0])


@pytest.mark.parametrize("kind", ["i_clamp", "u_clamp"])
def test_crossed_clamps_are_refused(kind: str) -> None:
    with pytest.raises(ParameterError, match=rf"'{kind}_min' is above {kind}_max: 1 > 0"):
        Pid([Gains(**{f"{kind}_min": 1.0, f"{kind}_max": 0.0})])


def test_no_clamps_are_infinite() -> None:
    assert run(Gains(i=1.0), [1e6] * 3, 1e3)[-1] == pytest.approx(3e9)
    assert math.isinf(Gains().u_clamp_max)
