"""Telegrams of KUKA RSI: those of controllers and other programs, every value there and back, and broken ones."""

import math
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.industry.rsi.telegrams import MAX_BYTES, Telegram, TelegramError, decode, encode

ROBOT = (
    b'<Rob Type="KUKA"><RIst X="1620.5" Y="0.0" Z="-1910.25" A="0.0" B="90.0" C="0.0"/><RSol X="1620.5" Y="0.0" '
    b'Z="-1910.25" A="0.0" B="90.0" C="0.0"/><AIPos A1="0.0" A2="-90.0" A3="90.0" A4="0.0" A5="90.0" A6="0.0"/>'
    b'<Delay D="3"/><EStr>Message</EStr><Digin>5</Digin><IPOC>4208163634</IPOC></Rob>'
)
NAMES = st.from_regex(r"[A-Za-z][A-Za-z0-9]{0,8}", fullmatch=True).filter(lambda name: name != "IPOC")
NUMBERS = st.floats(-1e6, 1e6).map(lambda value: round(value, 6))


def test_a_robot_s_telegram() -> None:
    telegram = decode(ROBOT, "Rob")
    assert telegram.ipoc == 4208163634
    assert telegram.sender == "KUKA"
    assert telegram.delay == 3
    assert telegram.groups["RIst"] == {"X": 1620.5, "Y": 0.0, "Z": -1910.25, "A": 0.0, "B": 90.0, "C": 0.0}
    assert telegram.groups["AIPos"]["A2"] == -90.0
    assert telegram.values == {"Digin": 5.0}


def test_an_answer_as_it_is_sent() -> None:
    answer = Telegram("Sen", "ImFree", 4208163634, {"RKorr": {"X": 0.0, "Y": -0.0125}}, {"Stop": 1.0})
    assert encode(answer) == (
        b'<Sen Type="ImFree"><RKorr X="0.000000" Y="-0.012500"/><Stop>1</Stop><IPOC>4208163634</IPOC></Sen>'
    )


def test_channels_with_numbers_for_names() -> None:
    telegram = Telegram("Rob", "KUKA", 1, {"GPIO": {"01": 1.0, "02": 0.0}})
    assert b'<GPIO 01="1.000000" 02="0.000000"/>' in encode(telegram)
    assert decode(encode(telegram), "Rob") == telegram


@given(
    st.sampled_from(["Rob", "Sen"]),
    st.integers(0, 2**63 - 1),
    st.dictionaries(NAMES, st.dictionaries(NAMES, NUMBERS, min_size=1, max_size=6), max_size=6),
    st.text(alphabet=st.characters(codec="ascii", categories=["L", "N", "P"]), max_size=8),
)
def test_there_and_back(kind, ipoc, groups, sender) -> None:  # type: ignore[no-untyped-def]
    telegram = Telegram(kind, sender, ipoc, groups)
    assert decode(encode(telegram) + b"\0\0", kind) == telegram


@given(st.binary(max_size=300))
def test_any_bytes_are_a_telegram_or_refused(data: bytes) -> None:
    with suppress(TelegramError):
        decode(data, "Rob")


@given(st.integers(0, len(ROBOT) - 1))
def test_a_telegram_that_was_cut_off_is_refused(length: int) -> None:
    with pytest.raises(TelegramError):
        decode(ROBOT[:length], "Rob")


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"<Sen><IPOC>1</IPOC></Sen>", "is <Sen>, but <Rob> is expected"),
        (b"<Rob><Delay D='0'/></Rob>", "has no IPOC"),
        (b"<Rob><IPOC>1.5</IPOC></Rob>", "one integer from 0 is expected"),
        (b"<Rob><IPOC>-1</IPOC></Rob>", "one integer from 0 is expected"),
        (b"<Rob><IPOC>1</IPOC><IPOC>2</IPOC></Rob>", "one integer from 0 is expected"),
        (b"<Rob><RIst X='nan'/><IPOC>1</IPOC></Rob>", "RIst.X is 'nan', but a finite number is expected"),
        (b"<Rob><RIst X='1,5'/><IPOC>1</IPOC></Rob>", "RIst.X is '1,5'"),
        (b"<!DOCTYPE Rob><Rob><IPOC>1</IPOC></Rob>", "holds a declaration"),
        (b" " * (MAX_BYTES + 1), "bytes long"),
    ],
)
def test_what_is_wrong_is_named(data: bytes, reason: str) -> None:
    with pytest.raises(TelegramError, match=reason):
        decode(data, "Rob")


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_no_number_that_is_not_finite_is_sent(value: float) -> None:
    with pytest.raises(TelegramError, match=r"RKorr.Y is .*, but must be finite"):
        encode(Telegram("Sen", "ImFree", 1, {"RKorr": {"Y": value}}))
