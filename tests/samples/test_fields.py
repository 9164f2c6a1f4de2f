import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.samples import fields


@given(st.integers(0, 2**31 * 10**9 - 1))
def test_stamps_come_back(stamp_ns: int) -> None:
    message = fields.time_message(stamp_ns)
    assert fields.nanoseconds(message) == stamp_ns
    assert fields.seconds(message) == pytest.approx(1e-9 * stamp_ns)


@given(st.floats(-1e6, 1e6))
def test_durations_are_rounded_to_nanoseconds_and_keep_their_sign(value: float) -> None:
    message = fields.duration_message(value)
    assert 0 <= message.nanosec < 10**9
    assert fields.seconds(message) == pytest.approx(value, abs=1e-9, rel=1e-9)
