"""A seam servo and its controllers: what they do without a seam, at their limits and with a strange robot."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from daidalos.common.extensions import find
from daidalos.industry.rsi.telegrams import Telegram
from daidalos.industry.servoing.butt_joint import SEAMS, ButtJoint
from daidalos.industry.servoing.contracts import LoopSetup, Observation, SeamController
from daidalos.industry.servoing.controllers.plant_model import robot_model
from daidalos.industry.servoing.extensions import SEAM_CONTROLLERS
from daidalos.industry.servoing.profile_sensor import ProfileSensor
from daidalos.industry.servoing.seam_servo import SeamServo, ServoSettings, State

Source = Callable[[int], NDArray[np.float64] | None]
NAMES = ("proportional", "lead", "feedforward", "lqg", "mpc")


class Constant(SeamController):
    """Controller that always wants the same."""

    def __init__(self, value: float) -> None:
        super().__init__(LoopSetup())
        self.value = value
        self.held = 0

    def step(self, observation: Observation) -> float:
        return self.value

    def hold(self) -> None:
        self.held += 1


class Robot:
    """Robot at 5 mm/s that does at once what it is told, and a servo for it."""

    def __init__(self, controller: SeamController, source: Source, **settings: float) -> None:
        self.cycle, self.lateral, self.start = 0, 0.0, 2000.0
        self.answers: list[float] = []
        self.stops: list[float] = []
        self.servo = SeamServo(controller, ServoSettings(**settings), lambda _: source(self.cycle))

    def telegram(self) -> Telegram:
        place = {"X": self.start + 0.06 * self.cycle, "Y": self.lateral, "Z": 900.0}
        return Telegram("Rob", "KUKA", 12 * self.cycle, {"RIst": place, "RSol": place})

    def run(self, cycles: int) -> None:
        for _ in range(cycles):
            answer = self.servo(self.telegram())
            self.answers.append(answer["RKorr"]["Y"])
            self.stops.append(answer["Stop"][""])
            self.lateral += answer["RKorr"]["Y"]
            self.cycle += 1


def profiles(lateral: float = 0.0) -> Source:
    sensor = ProfileSensor(ButtJoint(SEAMS["line"], irregularity=0.0))
    return lambda cycle: sensor.measure(0.06e-3 * cycle, lateral)


def test_without_a_seam_the_correction_is_held_and_then_the_robot_stops() -> None:
    seen = profiles()
    controller = Constant(0.01e-3)
    robot = Robot(controller, lambda cycle: seen(cycle) if cycle < 300 else None)
    robot.run(300)
    assert robot.servo.state is State.TRACKING
    robot.run(9)
    assert robot.servo.state is State.HOLDING
    held = robot.lateral
    robot.run(74)
    assert robot.servo.state is State.HOLDING
    assert (robot.lateral, controller.held) == (held, 1)
    robot.run(20)
    assert robot.servo.state is State.STOPPED
    assert robot.servo.reason.startswith("no seam was seen for 1 s, 23.0 mm after the first place of the robot")
    assert robot.lateral == held
    assert (robot.stops[0], robot.stops[-1]) == (0.0, 1.0)


def test_a_seam_that_is_seen_again_is_followed_again() -> None:
    seen = profiles()
    robot = Robot(Constant(0.01e-3), lambda cycle: None if 300 <= cycle < 320 else seen(cycle))
    robot.run(319)
    assert robot.servo.state is State.HOLDING
    robot.run(5)
    assert robot.servo.state is State.TRACKING


def test_a_seam_that_is_never_seen_stops_the_robot_uncorrected() -> None:
    robot = Robot(Constant(0.01e-3), lambda _: None)
    robot.run(100)
    assert robot.servo.state is State.STOPPED
    assert not any(robot.answers)


def test_a_joint_that_jumps_is_not_the_seam() -> None:
    seen, beside = profiles(), profiles(3e-3)
    robot = Robot(Constant(0.0), lambda cycle: seen(cycle) if cycle < 300 else beside(cycle))
    robot.run(400)
    assert robot.servo.state is State.STOPPED
    assert robot.servo.reason.startswith("no seam was seen")


def test_steps_and_sums_of_corrections_are_limited() -> None:
    robot = Robot(Constant(1.0), profiles())
    robot.run(300)
    assert max(robot.answers) == pytest.approx(0.06)
    robot.run(200)
    assert max(np.cumsum(robot.answers)) == pytest.approx(5.0)
    assert robot.servo.reason.startswith("the correction is at its limit of 5 mm")


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_controller_that_computes_nonsense_stops_the_robot(value: float) -> None:
    robot = Robot(Constant(value), profiles())
    robot.run(300)
    assert robot.servo.reason.startswith(f"the controller computed {value}")
    assert not any(robot.answers)


def test_a_robot_that_jumps_or_says_no_place_is_stopped() -> None:
    robot = Robot(Constant(0.0), profiles())
    robot.run(10)
    robot.start += 60.0
    robot.run(1)
    assert robot.servo.reason == "the robot's place jumped from 0.5 to 60.6 mm"
    blind = Robot(Constant(0.0), profiles())
    assert blind.servo(Telegram("Rob", "KUKA", 1, {"AIPos": {"A1": 0.0}}))["Stop"][""] == 1.0
    assert blind.servo.reason == "the robot's telegram has no RIst with X and Y"


def test_corrections_are_turned_into_the_robot_s_base() -> None:
    robot = Robot(Constant(0.01e-3), profiles(), heading=math.pi / 2.0)
    turned = [Telegram("Rob", "KUKA", 12 * cycle, {"RIst": {"X": 0.0, "Y": 0.06 * cycle}}) for cycle in range(300)]
    answers = []
    for cycle, telegram in enumerate(turned):
        robot.cycle = cycle
        answers.append(robot.servo(telegram)["RKorr"])
    assert (answers[-1]["X"], answers[-1]["Y"]) == pytest.approx((-0.01, 0.0), abs=1e-9)


def follow(name: str, seam: Callable[[NDArray[np.float64]], NDArray[np.float64]], cycles: int) -> NDArray[np.float64]:
    """Return the deviations of a robot as the controllers model it, on a seam that is known exactly [m]."""
    setup = LoopSetup(lead=0.0)
    controller = find(SEAM_CONTROLLERS, name)(setup)
    a, b, _ = robot_model(setup.model)
    state, out = np.zeros(3), []
    for cycle in range(cycles):
        s = setup.speed * setup.model.cycle * cycle
        observation = Observation(s, state[0], state[2], lambda at: float(seam(np.array([at]))[0]), seam)
        correction = float(np.clip(controller.step(observation), -setup.max_step, setup.max_step))
        out.append(float(state[0] - seam(np.array([s]))[0]))
        state = a @ state + b * correction
    return np.array(out)


@pytest.mark.parametrize("name", NAMES)
def test_controllers_bring_the_tool_onto_a_straight_seam(name: str) -> None:
    deviations = follow(name, lambda s: np.full(len(s), 1e-3), 500)
    assert abs(deviations[-1]) < 1e-6
    assert deviations.max() < 0.05e-3


@pytest.mark.parametrize(("name", "limit"), list(zip(NAMES, (0.5e-3, 0.35e-3, 5e-6, 5e-6, 5e-6), strict=True)))
def test_controllers_that_look_ahead_follow_a_curve(name: str, limit: float) -> None:
    deviations = follow(name, lambda s: 3e-3 * np.sin(s / 0.03), 3000)[500:]
    assert deviations.std() < limit
    if limit > 1e-4:
        assert deviations.std() > 0.02e-3


def test_the_predictive_controller_stays_within_the_sum_of_corrections() -> None:
    setup = LoopSetup(max_correction=0.5e-3)
    controller = find(SEAM_CONTROLLERS, "mpc")(setup)
    a, b, _ = robot_model(setup.model)
    state = np.zeros(3)
    for cycle in range(100):
        step = controller.step(
            Observation(0.06e-3 * cycle, state[0], state[2], lambda _: 1e-3, lambda s: np.full(len(s), 1e-3))
        )
        assert abs(step) <= setup.max_step + 2e-9
        state = a @ state + b * step
    assert state[2] == pytest.approx(0.5e-3, abs=2e-6)


def test_the_predictive_controller_solves_its_problem_as_a_general_solver_does() -> None:
    from scipy.optimize import minimize

    setup = LoopSetup(max_correction=0.5e-3)
    controller = find(SEAM_CONTROLLERS, "mpc")(setup)
    first = controller.step(Observation(0.0, 0.0, 0.0, lambda _: 1e-3, lambda s: np.full(len(s), 1e-3)))
    a, b, _ = robot_model(setup.model)

    def cost(steps: NDArray[np.float64]) -> float:
        state, out = np.zeros(3), 0.0
        for step in steps:
            state = a @ state + b * step
            out += (state[0] - 10.0) ** 2 + step**2
        return out

    sums = {"type": "ineq", "fun": lambda steps: 5.0 - np.cumsum(steps)}
    best = minimize(cost, np.zeros(30), method="SLSQP", bounds=[(-0.6, 0.6)] * 30, constraints=[sums])
    assert first == pytest.approx(1e-4 * best.x[0], abs=1e-7)
