"""Payloads of MQTT messages: text of single values, JSON and CDR, there and back, and what is refused."""

from __future__ import annotations

import json
import math
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
import std_msgs.msg
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped
from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import serialize_message
from sensor_msgs.msg import LaserScan

from daidalos.nodes.mqtt_client import _payloads as payloads
from daidalos.nodes.mqtt_client._payloads import PayloadError


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("Bool", True, b"true"),
        ("UInt8", 255, b"255"),
        ("Int64", -(2**63), b"-9223372036854775808"),
        ("Float32", 0.5, b"0.5"),
        ("Float64", 42.0, b"42.0"),
        ("Float64", 0.1, b"0.1"),
        ("String", "größer", "größer".encode()),
        ("UInt8MultiArray", [0, 255, 10], b"\x00\xff\n"),
    ],
)
def test_text_of_single_values(name: str, value: Any, text: bytes) -> None:
    kind, type_name = getattr(std_msgs.msg, name), f"std_msgs/msg/{name}"
    message = kind(data=value)
    assert payloads.primitive_text(type_name, message) == text
    assert payloads.primitive_message(kind, type_name, text) == message


@pytest.mark.parametrize(
    ("text", "name"),
    [
        (b"TRUE", "Bool"),
        (b"1", "Int32"),
        (b"-2147483648", "Int32"),
        (b"2147483648", "Float32"),
        (b"1e3", "Float32"),
        (b"nan", "Float32"),
        (b"1_000", "String"),
        (b"", "String"),
        (b"9" * 5000, "Float32"),
    ],
)
def test_what_a_text_is_taken_for(text: bytes, name: str) -> None:
    assert payloads.primitive_type(text) == f"std_msgs/msg/{name}"


@pytest.mark.parametrize(
    ("name", "text", "problem"),
    [
        ("UInt8", b"256", "does not fit UInt8"),
        ("UInt8", b"-1", "does not fit UInt8"),
        ("Float32", b"1e39", "in the range of float32"),
        ("Int32", b"1.5", "is no Int32"),
        ("Bool", b"yes", "is no Bool"),
        ("Float64", b"1_0", "is no Float64"),
        ("String", b"\xff", "not valid UTF-8"),
        ("Header", b"1", "has no single value"),
    ],
)
def test_texts_that_are_refused(name: str, text: bytes, problem: str) -> None:
    with pytest.raises(PayloadError, match=problem):
        payloads.primitive_message(getattr(std_msgs.msg, name), f"std_msgs/msg/{name}", text)


def test_json_there_and_back() -> None:
    pose = PoseStamped()
    pose.header.frame_id, pose.header.stamp.sec, pose.pose.position.x = "map", 3, 0.25
    text = payloads.to_json(pose)
    assert json.loads(text)["pose"]["position"] == {"x": 0.25, "y": 0.0, "z": 0.0}
    assert payloads.from_json(PoseStamped, text) == pose
    assert payloads.from_json(PoseStamped, b"{}") == PoseStamped()


def test_numbers_that_json_does_not_know() -> None:
    text = payloads.to_json(LaserScan(ranges=[1.0, math.inf, math.nan]))
    assert json.loads(text)["ranges"] == [1.0, None, None]
    ranges = payloads.from_json(LaserScan, text).ranges
    assert ranges[0] == 1.0
    assert all(math.isnan(one) for one in ranges[1:])


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (b"{", "not valid JSON"),
        (b"[" * 100_000, "not valid JSON"),
        (b"[1]", "no JSON object"),
        (b'{"framed": 1}', "no attribute 'framed'"),
        (b'{"stamp": {"sec": 1e99}}', "does not fit"),
        (b'{"stamp": 4}', "does not fit"),
        (b'{"frame_id": null}', "does not fit"),
        (b"\xff\xfe", "UTF-8"),
    ],
)
def test_json_that_is_refused(text: bytes, problem: str) -> None:
    with pytest.raises(PayloadError, match=problem):
        payloads.from_json(std_msgs.msg.Header, text)


def test_time_of_sending_precedes_the_message() -> None:
    message = serialize_message(std_msgs.msg.String(data="hi"))
    assert payloads.STAMP_LENGTH == 12
    assert payloads.split_stamp(serialize_message(Time(sec=5)) + message) == (Time(sec=5), message)
    with pytest.raises(PayloadError, match="is no Time"):
        payloads.split_stamp(b"\x00\x01")


@given(st.binary(max_size=200))
def test_nonsense_is_a_message_or_refused(payload: bytes) -> None:
    for read in (
        lambda: payloads.check_cdr(PoseStamped, payload),
        lambda: payloads.from_json(PoseStamped, payload),
        lambda: payloads.primitive_message(std_msgs.msg.Int16, "std_msgs/msg/Int16", payload),
        lambda: payloads.primitive_type(payload),
    ):
        with suppress(PayloadError):
            read()


@given(st.floats(width=32))
def test_floats_there_and_back(value: float) -> None:
    text = payloads.primitive_text("std_msgs/msg/Float32", std_msgs.msg.Float32(data=value))
    again = payloads.primitive_message(std_msgs.msg.Float32, "std_msgs/msg/Float32", text).data
    assert np.float32(again) == value or (math.isnan(again) and math.isnan(value))
    assert payloads.primitive_type(text) == "std_msgs/msg/Float32"
