"""Statistics against scipy's."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from daidalos.testing.statistics import compare_shares, compare_values, wilson_interval

counts = st.integers(1, 60).flatmap(lambda count: st.tuples(st.integers(0, count), st.just(count)))


@given(counts)
def test_wilson(pair: tuple[int, int]) -> None:
    expected = stats.binomtest(*pair).proportion_ci(0.95, "wilson")
    assert wilson_interval(*pair) == pytest.approx((expected.low, expected.high), abs=1e-12)


@given(counts, counts)
def test_fisher(first: tuple[int, int], second: tuple[int, int]) -> None:
    table = [[k, n - k] for k, n in (first, second)]
    assert compare_shares(first, second) == pytest.approx(stats.fisher_exact(table).pvalue, abs=1e-9)


def test_values() -> None:
    assert compare_values([], [1.0]) == 1.0
    assert compare_values([2.0, 2.0], [2.0]) == 1.0
    assert compare_values([1.0, 2.0, 3.0, 4.0], [11.0, 12.0, 13.0, 14.0]) < 0.05
    assert wilson_interval(0, 0) == (0.0, 1.0)
