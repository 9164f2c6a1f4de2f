"""CBOR and pictures."""

from __future__ import annotations

from typing import Any

import pytest
from geometry_msgs.msg import PoseWithCovariance
from hypothesis import given
from hypothesis import strategies as st
from rosbridge_library.internal import pngcompression
from rosbridge_library.internal.cbor_conversion import extract_cbor_values
from rosbridge_library.util.cbor import Tag, dumps


# Examples of RFC 8949, appendix A.
@pytest.mark.parametrize(
    ("value", "encoded"),
    [
        (0, "00"),
        (23, "17"),
        (24, "1818"),
        (1000, "1903e8"),
        (1000000, "1a000f4240"),
        (18446744073709551615, "1bffffffffffffffff"),
        (-1, "20"),
        (-1000, "3903e7"),
        (1.1, "fb3ff199999999999a"),
        (False, "f4"),
        (True, "f5"),
        (None, "f6"),
        (b"\x01\x02\x03\x04", "4401020304"),
        ("\u00fc", "62c3bc"),
        ([1, [2, 3], [4, 5]], "8301820203820405"),
        ({"a": 1, "b": [2, 3]}, "a26161016162820203"),
        (Tag(23, b"\x01\x02\x03\x04"), "d74401020304"),
    ],
)
def test_values_are_encoded_as_the_standard_says(value: Any, encoded: str) -> None:
    assert dumps(value).hex() == encoded


def test_what_cannot_be_encoded_is_refused() -> None:
    with pytest.raises(TypeError, match="object"):
        dumps(object())
    with pytest.raises(OverflowError):
        dumps(1 << 64)


def test_arrays_of_a_fixed_length_have_a_tag_too() -> None:
    values = extract_cbor_values(PoseWithCovariance())
    assert values["covariance"] == Tag(86, bytes(36 * 8))
    assert values["pose"]["orientation"]["w"] == 1.0


@given(st.text(max_size=200).filter(lambda text: "\n" not in text))
def test_a_text_survives_its_picture(text: str) -> None:
    assert pngcompression.decode(pngcompression.encode(text)) == text
