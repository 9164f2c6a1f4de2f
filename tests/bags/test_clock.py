import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.bags.clock import PlaybackClock


def test_time_runs_stands_still_and_jumps():
    clock = PlaybackClock(1000, 50, 2.0)
    assert clock.now(60) == 1020
    assert clock.due(1100) == 100
    clock.pause(60)
    assert (clock.now(99), clock.due(1100), clock.paused) == (1020, None, True)
    clock.set_rate(0.5, 70)
    clock.jump(5000, 80)
    assert clock.now(99) == 5000
    clock.resume(100)
    assert clock.now(110) == 5005
    assert clock.due(5010) == 120


@pytest.mark.parametrize("rate", [0.0, -1.0, float("nan"), float("inf")])
def test_rates_that_make_no_sense(rate):
    clock = PlaybackClock(0, 0)
    with pytest.raises(ValueError, match="expected a number above 0"):
        clock.set_rate(rate, 10)
    assert clock.rate == 1.0


steps = st.tuples(st.sampled_from(["pause", "resume", "rate"]), st.integers(0, 10**9), st.floats(0.01, 100))


@given(st.lists(steps, max_size=20), st.integers(0, 10**9))
def test_time_never_goes_back_and_what_is_due_is_now(changes, more):
    clock, steady, before = PlaybackClock(0, 0), 0, 0
    for what, wait, rate in changes:
        steady += wait
        if what == "rate":
            clock.set_rate(rate, steady)
        else:
            getattr(clock, what)(steady)
        assert clock.now(steady) >= before
        before = clock.now(steady)
    target = before + more
    due = clock.due(target)
    if due is None:
        assert clock.paused
    else:
        assert abs(clock.now(due) - target) <= clock.rate + 1
