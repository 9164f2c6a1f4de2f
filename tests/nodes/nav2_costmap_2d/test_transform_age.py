"""Ages of transforms, of those that are stamped ahead as well."""

import pytest

from daidalos.nodes.nav2_costmap_2d._transform_age import TransformAges

CYCLE_S = 0.05
CYCLES = 4
"""Number of cycles from one renewal of the transform to the next."""
PERIOD_S = CYCLES * CYCLE_S


def look(ages: TransformAges, cycle: int, ahead_s: float, end: int | None = None) -> float:
    """Return the age of a transform in a cycle; it is renewed each period, not from `end` on."""
    last = cycle if end is None else min(cycle, end - 1)
    return ages.age("map", last // CYCLES * CYCLES * CYCLE_S + ahead_s, cycle * CYCLE_S)


@pytest.mark.parametrize("ahead", [0.0, 0.2, 1.0])
def test_a_transform_that_is_renewed_is_as_old_as_its_stamp(ahead: float) -> None:
    ages = TransformAges()
    largest = max(look(ages, cycle, ahead) for cycle in range(600))
    assert largest <= max(PERIOD_S - ahead, 0.0) + 1e-6


@pytest.mark.parametrize("ahead", [0.0, 0.2, 1.0])
def test_a_transform_that_ends_ages_at_once_however_far_ahead_it_is_stamped(ahead: float) -> None:
    ages = TransformAges()
    found = [look(ages, cycle, ahead, end=200) for cycle in range(220)]
    assert max(found[:200]) <= max(PERIOD_S - ahead, 0.0) + 1e-6
    since_s = (219 - 196) * CYCLE_S
    assert found[-1] == pytest.approx(since_s - min(ahead, PERIOD_S), abs=0.06)


def test_a_pause_without_looks_is_no_period() -> None:
    ages = TransformAges()
    for begin in (0, 2000):
        for cycle in range(begin, begin + 200):
            look(ages, cycle, 1.0)
    assert look(ages, 2220, 1.0, end=2200) == pytest.approx((2220 - 2196) * CYCLE_S - PERIOD_S, abs=0.06)


def test_a_clock_that_is_set_back_starts_anew() -> None:
    ages = TransformAges()
    for cycle in range(1000, 1200):
        look(ages, cycle, 1.0)
    assert look(ages, 10, 1.0) <= 1e-6


def test_frames_have_ages_of_their_own() -> None:
    ages = TransformAges()
    assert ages.age("map", 11.0, 10.0) < 0.0
    assert ages.age("base_link", 9.0, 10.0) == 1.0
