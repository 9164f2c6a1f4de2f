"""Timers, rates, clocks and simulated time."""

import functools
import threading
import time
from typing import Any

import pytest
import rclpy
from rclpy.clock import Clock, ClockChange, JumpThreshold, ROSClock
from rclpy.clock_type import ClockType
from rclpy.context import Context
from rclpy.duration import Duration, Infinite
from rclpy.exceptions import NotInitializedException, ROSInterruptException
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time
from rclpy.timer import TimerInfo
from rosgraph_msgs.msg import Clock as ClockMessage

from ros.rclpy.waiting import LONG, executor_of, run_ready, spin_until

SIM = [Parameter("use_sim_time", value=True)]
MS = 1_000_000


class Simulator:
    """Publishes the time."""

    def __init__(self, node: Node) -> None:
        self._publisher = node.create_publisher(ClockMessage, "/clock", 1)
        self.now = Time(clock_type=ClockType.ROS_TIME)

    def advance(self, nanoseconds: int) -> None:
        self.now += Duration(nanoseconds=nanoseconds)
        self._publisher.publish(ClockMessage(clock=self.now.to_msg()))


@pytest.fixture
def simulator(node: Node) -> Simulator:
    return Simulator(node)


@pytest.fixture
def simulated(graph: Context) -> Node:
    return Node("simulated", parameter_overrides=SIM)


@pytest.mark.parametrize("period", [0.02, 0.001])
def test_a_timer_ticks_at_its_period(node: Node, period: float) -> None:
    ticks: list[int] = []
    begin = time.monotonic_ns()
    timer = node.create_timer(period, lambda: ticks.append(time.monotonic_ns()))
    spin_until(executor_of(node), lambda: len(ticks) == 10)
    assert ticks[-1] - begin >= 10 * period * 1e9
    assert timer.timer_period_ns == int(period * 1e9)


def test_a_timer_does_not_tick_early_nor_make_up_for_lost_time(simulator: Simulator, simulated: Node) -> None:
    ticks: list[int] = []
    executor = executor_of(simulated)
    simulator.advance(1000 * MS)
    run_ready(executor)
    simulated.create_timer(0.05, lambda: ticks.append(1))
    simulator.advance(49 * MS)
    run_ready(executor)
    assert ticks == []
    simulator.advance(200 * MS)  # several periods pass while nobody spins
    run_ready(executor)
    assert len(ticks) == 1


def test_a_timer_without_a_callback_is_warned_of(node: Node, capfd: pytest.CaptureFixture[str]) -> None:
    node.create_timer(1.0, None)
    assert "the callback of a timer is None" in capfd.readouterr().err


def test_a_timer_can_be_stopped_and_started(node: Node) -> None:
    timer = node.create_timer(0.001, lambda: None, autostart=False)
    assert timer.is_canceled()
    assert timer.time_until_next_call() is None
    timer.reset()
    assert not timer.is_canceled()
    assert timer.time_until_next_call() <= MS
    time.sleep(0.002)
    assert timer.is_ready()
    timer.cancel()
    assert not timer.is_ready()
    with pytest.raises(ValueError, match="negative"):
        node.create_timer(-1.0, lambda: None)


def test_a_timer_tells_when_it_was_due(node: Node) -> None:
    infos: list[TimerInfo] = []

    def tick(info: TimerInfo) -> None:
        infos.append(info)

    node.create_timer(0.001, functools.partial(tick))
    spin_until(executor_of(node), lambda: infos)
    assert 0 < infos[0].expected_call_time.nanoseconds <= infos[0].actual_call_time.nanoseconds
    assert TimerInfo().expected_call_time == Time()


def test_timers_of_a_simulation_tick_by_its_time(simulator: Simulator, simulated: Node, node: Node) -> None:
    ticks: list[TimerInfo] = []

    def tick(info: TimerInfo) -> None:
        ticks.append(info)

    simulated.create_timer(0.1, tick)
    executor = executor_of(simulated)
    for _ in range(99):
        simulator.advance(MS)
        run_ready(executor, 3)
    assert ticks == []
    simulator.advance(MS)
    run_ready(executor, 3)
    assert len(ticks) == 1
    assert ticks[0].actual_call_time == ticks[0].expected_call_time == simulator.now
    for count in range(2, 50):
        simulator.advance(100 * MS)
        run_ready(executor, 3)
        assert len(ticks) == count


def test_of_two_timers_that_cancel_each_other_one_ticks(simulator: Simulator, simulated: Node) -> None:
    executor, ticks = executor_of(simulated), []

    def tick() -> None:
        ticks.append(1)
        for timer in timers:
            timer.cancel()

    timers = [simulated.create_timer(0.01, tick) for _ in range(2)]
    for _ in range(3):
        simulator.advance(10 * MS)
        run_ready(executor)
    assert ticks == [1]


def test_a_clock_shows_what_the_simulator_says_whether_or_not_anybody_spins(
    simulator: Simulator, simulated: Node
) -> None:
    clock = simulated.get_clock()
    assert clock.now() == Time(clock_type=ClockType.ROS_TIME)
    simulator.advance(5 * MS)
    assert clock.now().nanoseconds == 5 * MS
    simulated.set_parameters([Parameter("use_sim_time", value=False)])
    assert abs(clock.now().nanoseconds - time.time_ns()) < 10 * 1_000_000_000
    result = simulated.set_parameters([Parameter("use_sim_time", value="maybe")])[0]
    assert not result.successful


def test_jumps_are_told_by_their_size(simulator: Simulator, simulated: Node) -> None:
    clock, told = simulated.get_clock(), []
    thresholds = {
        "forward": JumpThreshold(min_forward=Duration(nanoseconds=10), min_backward=None, on_clock_change=False),
        "backward": JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-10), on_clock_change=False),
        "change": JumpThreshold(min_forward=None, min_backward=None),
    }
    handles = [
        clock.create_jump_callback(
            threshold,
            pre_callback=lambda name=name: told.append((name, clock.now().nanoseconds)),
            post_callback=lambda jump, name=name: told.append((name, jump.clock_change, jump.delta.nanoseconds)),
        )
        for name, threshold in thresholds.items()
    ]
    simulator.advance(9)
    assert told == []
    simulator.advance(10)
    assert told == [("forward", 9), ("forward", ClockChange.ROS_TIME_NO_CHANGE, 10)]
    told.clear()
    simulator.now = Time(clock_type=ClockType.ROS_TIME)
    simulator.advance(0)
    assert told == [("backward", 19), ("backward", ClockChange.ROS_TIME_NO_CHANGE, -19)]
    told.clear()
    simulated.set_parameters([Parameter("use_sim_time", value=False)])
    assert [one[0] for one in told] == ["change", "change"]
    assert told[1][1] == ClockChange.ROS_TIME_DEACTIVATED
    for handle in handles:
        handle.unregister()
    told.clear()
    simulated.set_parameters(SIM)
    assert told == []


@pytest.mark.parametrize("forward", [0, -1])
def test_thresholds_must_make_sense(forward: int) -> None:
    with pytest.raises(ValueError, match="min_forward"):
        JumpThreshold(min_forward=Duration(nanoseconds=forward), min_backward=None)
    with pytest.raises(ValueError, match="min_backward"):
        JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-forward))
    with pytest.raises(ValueError, match="enabled"):
        JumpThreshold(min_forward=None, min_backward=None, on_clock_change=False)


@pytest.mark.parametrize("kind", [ClockType.SYSTEM_TIME, ClockType.STEADY_TIME, ClockType.ROS_TIME])
def test_clocks_of_every_kind(graph: Context, kind: ClockType) -> None:
    clock = Clock(clock_type=kind)
    assert isinstance(clock, ROSClock) is (kind is ClockType.ROS_TIME)
    begin = clock.now()
    assert clock.sleep_for(Duration(nanoseconds=10 * MS))
    assert clock.now() - begin >= Duration(nanoseconds=10 * MS)
    assert clock.sleep_until(begin), "that is past"
    other = ClockType.STEADY_TIME if kind is not ClockType.STEADY_TIME else ClockType.SYSTEM_TIME
    with pytest.raises(ValueError, match="clock type"):
        clock.sleep_until(Time(clock_type=other))
    with pytest.raises(NotInitializedException):
        clock.sleep_for(Duration(seconds=1), context=Context())


@pytest.mark.parametrize("end", ["reached", "deactivated", "shut down"])
def test_sleep_by_a_simulated_clock(graph: Context, end: str) -> None:
    clock, results, asleep = ROSClock(), [], threading.Event()
    clock._set_ros_time_is_active(True)
    until = Time(seconds=10, clock_type=ClockType.ROS_TIME)

    def sleep() -> None:
        asleep.set()
        results.append(clock.sleep_until(until))

    thread = threading.Thread(target=sleep)
    thread.start()
    asleep.wait(LONG)
    clock.set_ros_time_override(Time(seconds=9, clock_type=ClockType.ROS_TIME))
    if end == "reached":
        clock.set_ros_time_override(until)
    elif end == "deactivated":
        clock._set_ros_time_is_active(False)
    else:
        rclpy.shutdown()
    thread.join(LONG)
    assert results in ([end == "reached"], [True]) if end == "deactivated" else results == [end == "reached"]


def test_a_rate_needs_nobody_who_spins(node: Node) -> None:
    rate = node.create_rate(200.0)
    begin = time.monotonic()
    for _ in range(10):
        rate.sleep()
    assert 0.04 <= time.monotonic() - begin < LONG


def test_an_executor_is_told_of_the_rates_of_its_nodes(node: Node) -> None:
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    rate = node.create_rate(100.0)
    sleeper = threading.Thread(target=rate.sleep)
    sleeper.start()
    begin = time.monotonic()
    executor.spin_once(timeout_sec=LONG)
    assert time.monotonic() - begin < LONG / 2
    sleeper.join(LONG)
    executor.shutdown()


def test_a_rate_lets_a_loop_of_spin_once_go_on(node: Node) -> None:
    rate, ticks, done = node.create_rate(100.0), [], threading.Event()

    def loop() -> None:
        for _ in range(5):
            rate.sleep()
            ticks.append(time.monotonic())
        done.set()

    thread = threading.Thread(target=loop)
    thread.start()
    while not done.is_set():
        rclpy.spin_once(node)
    thread.join(LONG)
    assert len(ticks) == 5
    assert node.destroy_rate(rate)
    begin = time.monotonic()
    rclpy.spin_once(node, timeout_sec=0.1)  # what may still have been queued
    rclpy.spin_once(node, timeout_sec=0.1)
    assert time.monotonic() - begin >= 0.1


def test_a_rate_of_a_simulation_needs_nobody_who_spins(simulator: Simulator, simulated: Node) -> None:
    rate, slept = simulated.create_rate(100.0), threading.Semaphore(0)

    def loop() -> None:
        for _ in range(5):
            rate.sleep()
            slept.release()

    thread = threading.Thread(target=loop, daemon=True)
    thread.start()
    deadline = time.monotonic() + LONG
    while thread.is_alive() and time.monotonic() < deadline:
        simulator.advance(MS)
        time.sleep(0.0002)
    assert not thread.is_alive()
    assert simulator.now.nanoseconds >= 50 * MS


@pytest.mark.parametrize("end", ["destroyed", "shut down"])
def test_a_sleeping_rate_wakes_at_its_end(graph: Context, node: Node, end: str) -> None:
    rate, raised, asleep = node.create_rate(1e-6), [], threading.Event()

    def sleep() -> None:
        asleep.set()
        try:
            rate.sleep()
        except (ROSInterruptException, RuntimeError) as error:
            raised.append(type(error))

    thread = threading.Thread(target=sleep)
    thread.start()
    asleep.wait(LONG)
    if end == "destroyed":
        assert node.destroy_rate(rate)
    else:
        rclpy.shutdown()
    thread.join(LONG)
    assert not thread.is_alive()
    assert raised == [RuntimeError if end == "destroyed" else ROSInterruptException]


@pytest.mark.parametrize(("frequency", "error"), [(None, TypeError), (0.0, ValueError), (-1.0, ValueError)])
def test_rates_are_positive(node: Node, frequency: Any, error: type[Exception]) -> None:
    with pytest.raises(error):
        node.create_rate(frequency)


def test_times_and_durations_are_numbers_with_meaning() -> None:
    assert Time(seconds=1, nanoseconds=5e8).seconds_nanoseconds() == (1, 500_000_000)
    assert Duration(seconds=-1).nanoseconds == -1_000_000_000
    assert str(Infinite) == "Infinite"
    assert (Time(nanoseconds=3) - Time(nanoseconds=5)).nanoseconds == -2
    assert Duration(nanoseconds=1) + Time(nanoseconds=1) == Time(nanoseconds=2)
    assert Time.from_msg(Time(nanoseconds=7, clock_type=ClockType.ROS_TIME).to_msg()).nanoseconds == 7
    assert Duration.from_msg(Duration(nanoseconds=-7).to_msg()) == Duration(nanoseconds=-7)
    for wrong in (
        lambda: Time(seconds=-1),
        lambda: Time(nanoseconds=1) - Duration(nanoseconds=2),
    ):
        with pytest.raises(ValueError, match="negative"):
            wrong()
    for too_large in (
        lambda: Time(nanoseconds=2**63),
        lambda: Duration(nanoseconds=-(2**63) - 1),
        lambda: Time(nanoseconds=2**63 - 1) + Duration(nanoseconds=1),
    ):
        with pytest.raises(OverflowError):
            too_large()
    steady = Time(nanoseconds=1, clock_type=ClockType.STEADY_TIME)
    for mixed in (
        lambda: steady == Time(),
        lambda: steady < Time(),
        lambda: steady - Time(),
        lambda: steady + steady,
        lambda: steady > Duration(),
        lambda: Time(clock_type="STEADY_TIME"),
    ):
        with pytest.raises(TypeError):
            mixed()
    assert steady != 1


def test_a_single_threaded_executor_is_what_spin_uses(graph: Context) -> None:
    assert isinstance(rclpy.get_global_executor(), SingleThreadedExecutor)


def test_a_negative_time_is_ignored(simulator: Simulator, simulated: Node, node: Node) -> None:
    simulator.advance(5 * MS)
    negative = ClockMessage()
    negative.clock.sec = -3
    node.create_publisher(ClockMessage, "/clock", 1).publish(negative)
    assert simulated.get_clock().now().nanoseconds == 5 * MS
    simulator.advance(1 * MS)
    assert simulated.get_clock().now().nanoseconds == 6 * MS


def test_a_duration_without_end() -> None:
    assert Duration(seconds=2) * float("inf") == Infinite
    with pytest.raises(ValueError, match="NaN"):
        Duration(seconds=2) * float("nan")
