"""The simulated controller of KUKA RSI: answers that count, corrections, limits, and how the robot follows."""

from dataclasses import replace

import numpy as np
import pytest

from daidalos.industry.rsi.configuration import read_configuration
from daidalos.industry.rsi.controller import IPO_FAST, ControllerSettings, SimulatedController
from daidalos.industry.rsi.telegrams import Telegram, decode, encode

from .test_configuration import FILE

CONFIGURATION = read_configuration(FILE)


def controller(**settings: object) -> SimulatedController:
    return SimulatedController(
        CONFIGURATION,
        lambda time: np.array([1000.0 + 5.0 * time, 0.0, 900.0, 0.0, 0.0, 180.0]),
        replace(ControllerSettings(), **settings),  # type: ignore[arg-type]
        start_ipoc=1000,
    )


def answer(one: SimulatedController, y: float, **changes: object) -> str:
    telegram = Telegram("Sen", "ImFree", one.ipoc, {"RKorr": {"Y": y}})
    return one.take(encode(replace(telegram, **changes)))  # type: ignore[arg-type]


def test_telegrams_and_their_times() -> None:
    for cycle, ipocs in ((0.012, [1000, 1012, 1024]), (IPO_FAST, [1000, 1004, 1008])):
        robot, seen = controller(cycle=cycle), []
        for _ in range(3):
            telegram = decode(robot.telegram(), "Rob")
            seen.append(telegram.ipoc)
            assert list(telegram.groups) == ["RIst", "RSol", "AIPos", "ASPos", "Delay"]
            assert telegram.groups["RIst"]["X"] == pytest.approx(1000.0 + 5e-3 * (telegram.ipoc - 1000))
            assert answer(robot, 0.0) == ""
            robot.step()
        assert seen == ipocs


def test_relative_corrections_are_added_and_absolute_ones_are_not() -> None:
    for relative, expected in ((True, 0.3), (False, 0.1)):
        robot = controller(relative=relative)
        for _ in range(3):
            answer(robot, 0.1)
            robot.step()
        assert robot.correction[1] == pytest.approx(expected)


def test_lost_answers_are_counted_reported_and_end_the_motion() -> None:
    robot = controller(max_lost=3)
    robot.step()
    robot.step()
    assert decode(robot.telegram(), "Rob").delay == 2
    answer(robot, 0.1)
    robot.step()
    assert decode(robot.telegram(), "Rob").delay == 0
    for _ in range(3):
        assert not robot.stopped
        robot.step()
    assert robot.stopped == "3 answers in a row were lost"
    assert robot.total_lost == 5


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"ipoc": 988}, "IPOC is 988, but 1000 is expected"),
        ({"sender": "Other"}, "Type is 'Other', but 'ImFree' is expected"),
    ],
)
def test_answers_that_do_not_count(changes: dict[str, object], reason: str) -> None:
    robot = controller()
    assert answer(robot, 0.1, **changes) == reason
    assert "XML" in robot.take(b"<Sen")
    robot.step()
    assert robot.lost == 1
    assert not robot.correction.any()


def test_a_lost_answer_repeats_the_correction_only_where_the_file_says_so() -> None:
    held = replace(CONFIGURATION, received=tuple(replace(one, holds=True) for one in CONFIGURATION.received))
    for configuration, expected in ((CONFIGURATION, 0.1), (held, 0.3)):
        robot = SimulatedController(configuration, lambda _: np.zeros(6))
        answer(robot, 0.1)
        for _ in range(3):
            robot.step()
        assert robot.correction[1] == pytest.approx(expected)


def test_corrections_end_at_their_limits() -> None:
    robot = controller(position_limit=0.25)
    for _ in range(5):
        answer(robot, 0.1)
        robot.step()
    assert robot.correction[1] == 0.25
    assert not robot.stopped
    monitored = controller(monitor=0.15)
    for _ in range(2):
        answer(monitored, 0.1)
        monitored.step()
    assert monitored.stopped == "the correction is 0.200 mm, but 0.15 mm are allowed"


def test_the_sensor_stops_the_robot() -> None:
    robot = controller()
    answer(robot, 0.1, values={"Stop": 1.0})
    robot.step()
    assert robot.stopped == "the sensor asked for it"
    assert not robot.correction.any()


def test_the_robot_follows_as_a_system_of_second_order() -> None:
    robot = controller(relative=False, position_limit=10.0)
    moved = []
    for _ in range(100):
        answer(robot, 1.0)
        robot.step()
        moved.append(robot.pose[1])
    time = 0.012 * np.arange(1, 101)
    damped = 10.0 * np.sqrt(1 - 0.49)
    exact = 1.0 - np.exp(-7.0 * time) * (np.cos(damped * time) + 7.0 / damped * np.sin(damped * time))
    assert np.allclose(moved, exact, atol=1e-9)


def test_a_turning_correction_turns_about_the_axes_of_the_base() -> None:
    robot = controller(relative=False)
    turn = Telegram("Sen", "ImFree", robot.ipoc, {"RKorr": {"A": 2.0}})
    robot.take(encode(turn))
    robot.step()
    set_pose = decode(robot.telegram(), "Rob").groups["RSol"]
    assert (set_pose["A"], abs(set_pose["C"])) == pytest.approx((2.0, 180.0))
