"""Statuses and the tasks that fill them in."""

import pytest
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from diagnostic_updater import (
    CompositeDiagnosticTask,
    DiagnosticStatusWrapper,
    DiagnosticTask,
    DiagnosticTaskVector,
    FrequencyStatus,
    FrequencyStatusParam,
    FunctionDiagnosticTask,
    Heartbeat,
    TimeStampStatus,
    TimeStampStatusParam,
)
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.time import Time

OK, WARN, ERROR, STALE = (getattr(DiagnosticStatus, name) for name in ("OK", "WARN", "ERROR", "STALE"))


def values(status: DiagnosticStatus) -> dict[str, str]:
    return {one.key: one.value for one in status.values}


class Hand:
    """A clock set by hand."""

    def __init__(self) -> None:
        self.clock = Clock(clock_type=ClockType.ROS_TIME)
        self.clock._set_ros_time_is_active(True)
        self.now = 1000.0
        self.wait(0.0)

    def wait(self, seconds: float) -> None:
        self.now += seconds
        time = Time(nanoseconds=round(self.now * 1e9), clock_type=ClockType.ROS_TIME)
        self.clock.set_ros_time_override(time)


# Statuses


def test_a_status_is_a_message() -> None:
    status = DiagnosticStatusWrapper(level=WARN, name="n", message="m", hardware_id=None)
    assert isinstance(status, DiagnosticStatus)
    assert (status.level, status.name, status.message, status.hardware_id) == (WARN, "n", "m", "")
    assert DiagnosticStatusWrapper(WARN, "n", "m").message == "m"
    with pytest.raises(AssertionError, match="colour"):
        DiagnosticStatusWrapper(colour="red")


def test_summary() -> None:
    status, other = DiagnosticStatusWrapper(), DiagnosticStatusWrapper()
    status.summary(WARN, "first")
    assert (status.level, status.message) == (WARN, "first")
    status.summary(2, 5)
    assert (status.level, status.message) == (ERROR, "5")
    other.summary(status)
    assert (other.level, other.message) == (ERROR, "5")
    status.clearSummary()
    assert (status.level, status.message) == (OK, "")


@pytest.mark.parametrize(
    ("one", "two", "merged"),
    [
        ((OK, "a"), (OK, "b"), (OK, "a; b")),
        ((OK, ""), (OK, "b"), (OK, "b")),
        ((OK, "a"), (WARN, "b"), (WARN, "b")),
        ((WARN, "a"), (OK, "b"), (WARN, "a")),
        ((WARN, "a"), (ERROR, "b"), (ERROR, "a; b")),
        ((ERROR, "a"), (WARN, "b"), (ERROR, "a; b")),
        ((STALE, "a"), (ERROR, "b"), (STALE, "a; b")),
    ],
)
def test_merging(one: tuple[bytes, str], two: tuple[bytes, str], merged: tuple[bytes, str]) -> None:
    by_values, by_status, other = (DiagnosticStatusWrapper() for _ in range(3))
    for status in (by_values, by_status):
        status.summary(*one)
    other.summary(*two)
    by_values.mergeSummary(*two)
    by_status.mergeSummary(other)
    for status in (by_values, by_status):
        assert (status.level, status.message) == merged


def test_adding_values() -> None:
    status = DiagnosticStatusWrapper()
    for key, value in (("text", "5.0"), ("number", 5), ("truth", True), ("list", [1, 2])):
        status.add(key, value)
    assert status.values[0] == KeyValue(key="text", value="5.0")
    assert values(status) == {"text": "5.0", "number": "5", "truth": "True", "list": "[1, 2]"}


# Tasks


def filled(level: bytes, message: str, **entries: object) -> object:
    def fill(status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        status.summary(level, message)
        for key, value in entries.items():
            status.add(key, value)
        return status

    return fill


def test_functions_as_tasks() -> None:
    task = FunctionDiagnosticTask("name", filled(WARN, "hot", celsius=90))
    status = task.run(DiagnosticStatusWrapper())
    assert task.getName() == "name"
    assert (status.level, status.message, values(status)) == (WARN, "hot", {"celsius": "90"})
    untouched = DiagnosticStatusWrapper(message="as it was")
    assert DiagnosticTask("idle").run(untouched) is untouched


def test_tasks_together() -> None:
    both = CompositeDiagnosticTask("both")
    both.addTask(FunctionDiagnosticTask("a", filled(WARN, "hot", celsius=90)))
    both.addTask(FunctionDiagnosticTask("b", filled(OK, "fine", volt=12)))
    both.addTask(FunctionDiagnosticTask("c", filled(ERROR, "slow", hertz=1)))
    status = both.run(DiagnosticStatusWrapper())
    assert (status.level, status.message) == (ERROR, "hot; slow")
    assert values(status) == {"celsius": "90", "volt": "12", "hertz": "1"}


def test_tasks_together_do_not_see_each_other_s_summaries() -> None:
    seen: list[tuple[bytes, str]] = []

    def look(status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        seen.append((status.level, status.message))
        status.summary(ERROR, "mine")
        return status

    both = CompositeDiagnosticTask("both")
    for _ in range(2):
        both.addTask(FunctionDiagnosticTask("look", look))
    status = DiagnosticStatusWrapper()
    status.summary(WARN, "as it was")
    both.run(status)
    assert seen == [(WARN, "as it was")] * 2


def test_lists_of_tasks() -> None:
    tasks = DiagnosticTaskVector()
    tasks.add(Heartbeat())
    tasks.add("function", filled(OK, "fine"))
    tasks.add("function", filled(WARN, "the second"))
    assert [task.name for task in tasks.tasks] == ["Heartbeat", "function", "function"]
    status = tasks.tasks[0].run(DiagnosticStatusWrapper())
    assert (status.name, status.level, status.message) == ("Heartbeat", OK, "Alive")
    assert tasks.removeByName("function") is True
    assert tasks.tasks[1].run(DiagnosticStatusWrapper()).message == "the second"
    assert tasks.removeByName("nothing") is False
    for wrong in ((), (1, 2, 3)):
        with pytest.raises(TypeError, match="a task, or a name and a function"):
            tasks.add(*wrong)


# Frequencies


def test_frequencies() -> None:
    hand = Hand()
    task = FrequencyStatus(FrequencyStatusParam({"min": 10, "max": 20}, 0.5, 2), clock=hand.clock)

    def after(seconds: float, ticks: int) -> tuple[bytes, str]:
        for _ in range(ticks):
            task.tick()
        hand.wait(seconds)
        status = task.run(DiagnosticStatusWrapper())
        return status.level, status.message

    assert task.getName() == "FrequencyStatus"
    assert after(0.02, 1) == (WARN, "Frequency too high.")
    assert after(0.05, 1) == (OK, "Desired frequency met")  # 2 in 0.07 s
    assert after(0.3, 1) == (OK, "Desired frequency met")  # 2 in 0.35 s
    assert after(0.15, 1) == (WARN, "Frequency too low.")  # 2 in 0.45 s
    assert after(0.15, 0)[0] == WARN
    assert after(0.15, 0) == (ERROR, "No events recorded.")
    task.tick()
    task.clear()
    assert after(0.0, 0) == (ERROR, "No events recorded.")
    assert after(0.0, 1)[1] == "Frequency too high."


def test_what_is_told_of_a_frequency() -> None:
    hand = Hand()
    bound = {"min": 10.0, "max": 10.0}
    task = FrequencyStatus(FrequencyStatusParam(bound), clock=hand.clock)
    for _ in range(5):
        task.tick()
    hand.wait(0.5)
    assert values(task.run(DiagnosticStatusWrapper())) == {
        "Events in window": "5",
        "Events since startup": "5",
        "Duration of window (s)": "0.500000",
        "Actual frequency (Hz)": "10.000000",
        "Target frequency (Hz)": "10.000000",
        "Minimum acceptable frequency (Hz)": "9.000000",
        "Maximum acceptable frequency (Hz)": "11.000000",
    }
    del bound["max"]
    bound["min"] = 0.0
    assert set(values(task.run(DiagnosticStatusWrapper()))) == {
        "Events in window",
        "Events since startup",
        "Duration of window (s)",
        "Actual frequency (Hz)",
    }


# Stamps


@pytest.mark.parametrize(
    ("delays", "level", "message"),
    [
        ([], WARN, "No data since last update."),
        ([0.0], OK, "Timestamps are reasonable."),
        ([4.9, -0.9], OK, "Timestamps are reasonable."),
        ([-2.0], ERROR, "Timestamps too far in future seen."),
        ([6.0], ERROR, "Timestamps too far in past seen."),
        ([0.0, 6.0, 0.0], ERROR, "Timestamps too far in past seen."),
    ],
)
def test_stamps(delays: list[float], level: bytes, message: str) -> None:
    hand = Hand()
    task = TimeStampStatus(TimeStampStatusParam(), clock=hand.clock)
    for delay in delays:
        task.tick(hand.now - delay)
    status = task.run(DiagnosticStatusWrapper())
    assert (status.level, status.message) == (level, message)
    assert task.run(DiagnosticStatusWrapper()).message == "No data since last update."


def test_stamps_of_every_form() -> None:
    hand = Hand()
    task = TimeStampStatus(clock=hand.clock)
    assert task.getName() == "Timestamp Status"
    time = Time(nanoseconds=round((hand.now - 2.0) * 1e9))
    for stamp in (hand.now - 2.0, time, time.to_msg(), int(hand.now) - 2):
        task.tick(stamp)
        told = values(task.run(DiagnosticStatusWrapper()))
        assert float(told["Earliest timestamp delay:"]) == pytest.approx(2.0)
        assert float(told["Latest timestamp delay:"]) == pytest.approx(2.0)


@pytest.mark.parametrize("zero", [0.0, 0, Time(), Time().to_msg()])
def test_stamps_of_zero(zero: object) -> None:
    hand = Hand()
    task = TimeStampStatus(clock=hand.clock)
    for also in (None, hand.now):
        task.tick(zero)
        if also is not None:
            task.tick(also)
        status = task.run(DiagnosticStatusWrapper())
        assert (status.level, status.message) == (ERROR, "Zero timestamp seen.")
    assert values(status)["Zero seen diagnostic update count:"] == "2"


def test_tallies_of_bad_stamps() -> None:
    hand = Hand()
    task = TimeStampStatus(TimeStampStatusParam(-1, 5), "mine", clock=hand.clock)
    for delay in (9.0, 9.0, -3.0, 0.0):
        task.tick(hand.now - delay)
        told = values(task.run(DiagnosticStatusWrapper()))
    assert told == {
        "Earliest timestamp delay:": "0.000000",
        "Latest timestamp delay:": "0.000000",
        "Earliest acceptable timestamp delay:": "-1.000000",
        "Latest acceptable timestamp delay:": "5.000000",
        "Late diagnostic update count:": "2",
        "Early diagnostic update count:": "1",
        "Zero seen diagnostic update count:": "0",
    }


def test_tasks_do_not_share_what_is_right_by_default() -> None:
    one, two = TimeStampStatus(), TimeStampStatus()
    one.params.max_acceptable = 99
    assert two.params.max_acceptable == 5
