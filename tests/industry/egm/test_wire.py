"""EGM's messages as bytes: known ones, all values forth and back, and anything that is no message."""

import contextlib
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.industry.egm.messages import (
    EgmCartesian,
    EgmEuler,
    EgmHeader,
    EgmJoints,
    EgmPathCorr,
    EgmPlanned,
    EgmPose,
    EgmRobot,
    EgmSensor,
    EgmSensorPathCorr,
    MessageType,
)
from daidalos.industry.egm.wire import WireError, decode, encode


def double(value):
    return struct.pack("<d", value)


def test_a_message_has_the_bytes_of_protocol_buffers():
    message = EgmSensor(EgmHeader(300, 7, MessageType.CORRECTION), EgmPlanned(joints=EgmJoints((1.5, -2.0))), None)
    joints = b"\x09" + double(1.5) + b"\x09" + double(-2.0)
    planned = b"\x0a" + bytes([len(joints)]) + joints
    header = b"\x08\xac\x02\x10\x07\x18\x03"
    assert encode(message) == b"\x0a" + bytes([len(header)]) + header + b"\x12" + bytes([len(planned)]) + planned
    assert decode(EgmSensor, encode(message)) == message


@given(st.from_type(EgmRobot))
def test_all_values_of_the_controller_come_back(message):
    data = encode_or_skip(message)
    if data is not None:
        assert repr(decode(EgmRobot, data)) == repr(message)


@given(st.from_type(EgmSensor))
def test_all_values_of_a_program_come_back(message):
    data = encode_or_skip(message)
    if data is not None:
        assert repr(decode(EgmSensor, data)) == repr(message)


def encode_or_skip(message):
    """Return the bytes, None where a number is outside of those that the format has."""
    try:
        data = encode(message)
    except ValueError:
        return None
    return data if max(numbers_of(message), default=0) < 2**63 else None


def numbers_of(message):
    for value in vars(message).values():
        if isinstance(value, int):
            yield value
        elif hasattr(value, "__dataclass_fields__"):
            yield from numbers_of(value)


@given(st.binary(max_size=200), st.sampled_from([EgmRobot, EgmSensor, EgmSensorPathCorr]))
def test_anything_else_is_refused_in_words(data, type_):
    with contextlib.suppress(WireError):
        decode(type_, data)


@given(st.integers(0, 60), st.integers(0, 255))
def test_a_damaged_message_is_refused_or_another_one(place, byte):
    data = bytearray(encode(EgmSensor(EgmHeader(1, 2, 3), EgmPlanned(joints=EgmJoints((1.0,) * 6)))))
    data[place] = byte
    with contextlib.suppress(WireError):
        decode(EgmSensor, bytes(data))


def test_unknown_fields_are_skipped_and_packed_numbers_are_read():
    joints = b"\x0a\x10" + double(1.0) + double(2.0)
    planned = b"\x0a" + bytes([len(joints)]) + joints
    unknown = b"\x58\x05" + b"\x62\x03abc" + b"\x6d\x00\x00\x00\x00"
    found = decode(EgmSensor, unknown + b"\x12" + bytes([len(planned)]) + planned)
    assert found.planned.joints.joints == (1.0, 2.0)


@pytest.mark.parametrize(
    ("type_", "data", "message"),
    [
        (EgmPathCorr, encode(EgmCartesian(1.0, 2.0, 3.0))[:0], "EgmPathCorr has no pos"),
        (EgmEuler, b"\x09" + double(1.0), "EgmEuler has no y"),
        (EgmPose, b"\x0a\x05\x09", "a field of 5 bytes is cut off after 1"),
        (EgmHeader, b"\x08", "a number is cut off"),
        (EgmHeader, b"\x08" + b"\xff" * 11, "a number of more than 10 bytes"),
        (EgmHeader, b"\x0b", "a field of the unknown kind 3"),
        (EgmHeader, b"\x09" + double(1.0), "seqno is of the kind 1, which does not fit"),
        (EgmJoints, b"\x0a\x03abc", "joints has 3 bytes, which are no doubles"),
    ],
)
def test_what_is_wrong_is_named(type_, data, message):
    with pytest.raises(WireError, match=message):
        decode(type_, data)
