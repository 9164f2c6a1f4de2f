"""CDR both ways: bytes that a real ROS 2 wrote, an independent implementation, any values, any bytes."""

from __future__ import annotations

import json
import time
import tracemalloc
from array import array
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import Pose
from hypothesis import HealthCheck, given
from hypothesis import strategies as st
from nav_msgs.msg import Path as NavigationPath
from rcl_interfaces.msg import Parameter, ParameterEvent
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_typestore
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Empty, Int32, String
from test_msgs.msg import BoundedSequences, Strings, WStrings

from daidalos.interfaces.codec import CdrError, Codec, _has_wide_strings, codec_of
from daidalos.interfaces.codec._encoder import Encoder
from daidalos.interfaces.codec._text import Variant
from daidalos.interfaces.message import Message
from interfaces.messages import NAMES, PACKAGES, class_of, from_plain, messages, to_plain
from properties import examples

QUICK = examples(15, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
WIDTHS = (2, 4)
STORE = get_typestore(Stores.ROS2_JAZZY)
# rosbags takes an empty message for nothing at all.
KNOWN_TO_ROSBAGS = [name for name in NAMES if name in STORE.fielddefs and class_of(name)._FIELDS]


def names_of(package: str) -> list[str]:
    return [name for name in NAMES if name.split("/")[0] == package]


@pytest.fixture(scope="module")
def recorded(shared_data: Path) -> dict[str, Any]:
    """Bytes that a real ROS 2 wrote, with the values."""
    return json.loads((shared_data / "wire" / "cdr_vectors.json").read_text())


def test_bytes_are_those_of_a_real_ros(recorded):
    wrong = []
    for name, entry in recorded.items():
        kind = class_of(name)
        assert entry["type_hash"] == kind._TYPE_HASH, name
        for case in entry["cases"]:
            written = bytes.fromhex(case["cdr_hex"])
            message = from_plain(kind, case["fields"])
            if codec_of(kind).encode(message) != written or codec_of(kind).decode(written) != message:
                wrong.append((name, case["variant"]))
    assert wrong == []
    assert len(recorded) > 100


def test_classes_carry_the_hashes_of_a_real_build(shared_data):
    recorded = json.loads((shared_data / "wire" / "type_hashes.json").read_text())
    assert {name: class_of(name)._TYPE_HASH for name in recorded} == recorded


@pytest.mark.parametrize("wide", WIDTHS)
@pytest.mark.parametrize("package", PACKAGES)
@QUICK
@given(data=st.data())
def test_what_is_encoded_is_decoded(package, wide, data):
    kind = class_of(data.draw(st.sampled_from(names_of(package))))
    message, codec = data.draw(messages(kind)), codec_of(kind, wide)
    written = codec.encode(message)
    assert codec.decode(written) == message
    assert codec.decode(written + bytes(-len(written) % 4)) == message
    assert b"".join(codec.parts(message)) == written
    twin = codec.snapshot(message)
    assert twin == message
    assert codec.encode(twin) == written


@pytest.mark.parametrize("package", PACKAGES)
@QUICK
@given(data=st.data())
def test_big_endian_data_are_read(package, data):
    kind = class_of(data.draw(st.sampled_from(names_of(package))))
    message = data.draw(messages(kind))
    if any(many != "single" or not isinstance(base, str) or base == "wstring" for _, base, many, *_ in kind._FIELDS):
        return  # arrays are written in our own order only: nobody asks for the other
    text, names = Encoder(kind, Variant(">")).source()
    scope: dict[str, Any] = {"array": array, **names}
    exec(text, scope)
    assert codec_of(kind).decode(b"\0\0\0\0" + b"".join(scope["parts"](message))[4:]) == message


def test_big_endian_arrays_are_read():
    written = b"\0\0\0\0" + bytes(8) + b"\0\0\0\1\0\0\0\0" + bytes(4) + b"\0\0\0\1" + b"\x3f\xf8" + bytes(6) + bytes(8)
    assert codec_of(JointState).decode(written).position == array("d", [1.5])


@pytest.mark.slow
@pytest.mark.parametrize("name", KNOWN_TO_ROSBAGS)
@examples(5, parent=QUICK)
@given(data=st.data())
def test_an_independent_implementation_agrees(name, data):
    kind = class_of(name)
    message = data.draw(messages(kind))
    written = codec_of(kind).encode(message)
    theirs = STORE.deserialize_cdr(written, name)
    assert same(name, theirs, message)
    again = bytes(STORE.serialize_cdr(theirs, name))
    assert codec_of(kind).decode(again) == message


def same(name: str, theirs: Any, ours: Any) -> bool:
    """Compare a message of rosbags with ours."""
    for field, (node, detail) in STORE.fielddefs[name][1]:
        left, right = getattr(theirs, field), getattr(ours, field)
        nested = _nested(node, detail)
        if nested is None:
            if isinstance(right, list) and right and isinstance(right[0], bytes):
                left = [int(value) & 0xFF for value in left]  # theirs have a sign
            elif isinstance(right, bytes):
                left = int(left) & 0xFF
            if to_plain(_listed(left)) != to_plain(_listed(right)):
                return False
        elif node == Nodetype.NAME:
            if not same(nested, left, right):
                return False
        elif len(left) != len(right) or not all(same(nested, a, b) for a, b in zip(left, right, strict=True)):
            return False
    return True


def _nested(node: Any, detail: Any) -> str | None:
    if node == Nodetype.BASE:
        return None
    if node == Nodetype.NAME:
        return detail
    return _nested(*detail[0])


def _listed(value: Any) -> Any:
    return list(value) if isinstance(value, (np.ndarray, array, list)) else value


@pytest.mark.parametrize("package", PACKAGES)
@examples(40, parent=QUICK)
@given(data=st.data(), body=st.binary(max_size=400))
def test_any_bytes_are_a_message_or_a_clear_error(package, data, body):
    name = data.draw(st.sampled_from(names_of(package)))
    attempt(class_of(name), b"\0\1\0\0" + body)
    attempt(class_of(name), body)


@pytest.mark.slow
@pytest.mark.parametrize("package", PACKAGES)
@QUICK
@given(data=st.data())
def test_damaged_messages_are_messages_or_clear_errors(package, data):
    kind = class_of(data.draw(st.sampled_from(names_of(package))))
    written = bytearray(codec_of(kind).encode(data.draw(messages(kind))))
    sure = not _has_wide_strings(kind)  # half of a string of wide characters may be one of narrow ones
    attempt(kind, bytes(written[: data.draw(st.integers(0, len(written) - 1))]), must_fail=sure)
    attempt(kind, bytes(written) + b"\1" * 4, must_fail=sure)
    place = data.draw(st.integers(0, len(written) - 1))
    written[place] ^= data.draw(st.integers(1, 255))
    attempt(kind, bytes(written))


def attempt(kind: type[Message], data: bytes, must_fail: bool = False) -> None:
    """Decode; anything but a message or a `CdrError` that names the type fails the test."""
    try:
        codec_of(kind).decode(data)
    except CdrError as error:
        assert kind._TYPE_NAME in str(error)  # noqa: PT017
    else:
        assert not must_fail


@pytest.mark.slow
@pytest.mark.parametrize("kind", [Image, JointState, ParameterEvent, WStrings, BoundedSequences])
def test_absurd_counts_cost_neither_memory_nor_time(kind):
    for value in (b"\xff", b"\x7f", b"\x10"):
        for zeros in range(0, 64, 4):
            data = b"\0\1\0\0" + bytes(zeros) + value * 256
            codec = Codec(kind)
            with pytest.raises(CdrError):
                codec.decode(b"\0\1\0\0" + value * 4)  # compiles
            tracemalloc.start()
            begin = time.thread_time()
            attempt(kind, data)
            assert tracemalloc.get_traced_memory()[1] < 5_000_000
            tracemalloc.stop()
            assert time.thread_time() - begin < 2.0


@pytest.mark.parametrize(
    ("kind", "data", "words"),
    [
        (String, b"", "starts with nothing"),
        (String, b"\0\7\0\0abcd", "starts with 00 07 00 00"),
        (String, b"\0\1\0\0\xff\xff\xff\xff", "a string of 4294967295 bytes has no end"),
        (String, b"\0\1\0\0\3\0\0\0abc", "a string of 3 bytes has no end"),
        (Int32, b"\0\1\0\0\1\0\0\0\0\0\0\0", "4 bytes are left over"),
        (JointState, b"\0\1\0\0" + bytes(12) + b"\xff\0\0\0", "255 values do not fit"),
        (BoundedSequences, b"\0\1\0\0\4\0\0\0\1\1\1\1", "4 values, at most 3"),
    ],
)
def test_errors_say_what_is_wrong(kind, data, words):
    with pytest.raises(CdrError, match=words):
        codec_of(kind).decode(data)


def test_strings_longer_than_their_bound_are_refused():
    message = Strings()
    message._bounded_string_value = "x" * 23  # a peer without checks
    with pytest.raises(CdrError, match="longer than its bound, 22"):
        codec_of(Strings).decode(codec_of(Strings).encode(message))


def test_what_slipped_into_a_list_is_named_when_it_is_sent():
    state = JointState(name=["elbow"])
    state.name.append(7)
    with pytest.raises(CdrError, match="'name' field must be of type 'str', not 'int'"):
        codec_of(JointState).encode(state)
    event = ParameterEvent(new_parameters=[Parameter(name="speed")])
    event.new_parameters.append("speed")
    with pytest.raises(CdrError, match="'new_parameters' field must be a sub message of type 'Parameter'"):
        codec_of(ParameterEvent).encode(event)


def test_a_message_of_another_type_is_no_message_of_this_one():
    with pytest.raises(TypeError, match="expected a message of type 'std_msgs/msg/String', not 'Int32'"):
        codec_of(String).encode(Int32())


@pytest.mark.parametrize("function", ["encode", "parts", "snapshot"])
@pytest.mark.parametrize("error", [TypeError, CdrError])
def test_a_wrong_part_is_named(function: str, error: type[Exception]) -> None:
    path = NavigationPath()
    path.poses.append(Pose())  # no setter sees it
    words = r"nav_msgs/msg/Path: The 'poses' field must be a sub message of type 'PoseStamped', not 'Pose'"
    with pytest.raises(error, match=words):
        getattr(codec_of(NavigationPath), function)(path)
    array = JointState()
    array._position = None
    with pytest.raises(error, match="sensor_msgs/msg/JointState: The 'position' field"):
        getattr(codec_of(JointState), function)(array)


def test_snapshots_share_nothing_that_can_change():
    image = Image(data=b"abc")
    image.header.frame_id = "camera"
    twin = codec_of(Image).snapshot(image)
    image.data[0], image.header.frame_id = 0, "moved"
    assert bytes(twin.data) == b"abc"
    assert twin.header.frame_id == "camera"


def test_an_empty_message_is_one_octet():
    assert codec_of(Empty).encode(Empty()) == b"\0\1\0\0\0"


def test_wide_strings_take_two_bytes_over_zenoh_and_four_over_dds():
    message = WStrings(wstring_value="ab")
    assert codec_of(WStrings, 2).encode(message)[4:12] == b"\2\0\0\0a\0b\0"
    assert codec_of(WStrings, 4).encode(message)[4:16] == b"\2\0\0\0a\0\0\0b\0\0\0"
    for wide in WIDTHS:
        assert codec_of(WStrings, wide).decode(codec_of(WStrings, 6 - wide).encode(message)) == message
