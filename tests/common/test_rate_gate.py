"""A gate among cycles that are not its own."""

import pytest

from daidalos.common.rate_gate import RateGate

SECOND = 1_000_000_000


def times(rate, cycle_ns, count):
    gate = RateGate(rate)
    return [n * cycle_ns for n in range(count) if gate.is_due(n * cycle_ns)]


def test_it_is_due_at_its_rate_and_does_not_drift():
    """15 Hz among cycles of 1 ms: in the first cycle at or after each n / 15 s."""
    due = times(15.0, SECOND // 1000, 10_001)
    assert len(due) == 151
    assert all(0 <= at - n * SECOND / 15 < SECOND // 1000 for n, at in enumerate(due))


@pytest.mark.parametrize("rate", [0.0, -1.0, 2000.0])
def test_it_is_due_in_every_cycle_without_a_rate_or_with_a_higher_one(rate):
    assert len(times(rate, SECOND // 1000, 100)) == 100


def test_missed_times_are_not_made_up_for():
    gate = RateGate(10.0)
    assert gate.is_due(0)
    assert gate.is_due(10 * SECOND + 1)
    assert not gate.is_due(10 * SECOND + 2)


def test_it_starts_again_when_told_and_when_time_goes_back():
    gate = RateGate(1.0)
    assert gate.is_due(5 * SECOND)
    assert gate.is_due(0)
    assert not gate.is_due(SECOND // 2)
    gate.restart()
    assert gate.is_due(SECOND // 2)


def test_it_goes_on_when_time_is_set_back_between_two_openings():
    gate = RateGate(50e6)  # a period of 20 ns
    assert [now for now in (0, 10, 20, 35, 41, 45, 60, 5, 15, 25) if gate.is_due(now)] == [0, 20, 41, 60, 5, 25]
