"""What the buffer of transforms refuses, in the words that programs match."""

import math
import re

import pytest
import tf2_py
from geometry_msgs.msg import Quaternion
from tf2_py import BufferCore

from ros.transforms import (
    LATEST,
    SECOND,
    at,
    filled,
    transform,
)

# What goes wrong, in the words that programs match


@pytest.mark.parametrize(
    ("target", "source", "time", "kind", "words"),
    [
        ("no", "b", 1, tf2_py.LookupException, '"no" passed to lookupTransform argument target_frame does not exist. '),
        ("a", "no", 1, tf2_py.LookupException, '"no" passed to lookupTransform argument source_frame does not exist. '),
        (
            "",
            "b",
            1,
            tf2_py.InvalidArgumentException,
            'Invalid argument "" passed to lookupTransform argument target_frame - in tf2 frame_ids cannot be empty',
        ),
        (
            "a",
            "/b",
            1,
            tf2_py.InvalidArgumentException,
            'Invalid argument "/b" passed to lookupTransform argument source_frame - '
            "in tf2 frame_ids cannot start with a '/'",
        ),
        (
            "a",
            "y",
            1,
            tf2_py.ConnectivityException,
            "Could not find a connection between 'a' and 'y' because they are not part of the same tree."
            "Tf has two or more unconnected trees.",
        ),
        (
            "a",
            "b",
            3,
            tf2_py.ExtrapolationException,
            "Lookup would require extrapolation into the future.  Requested time 3.000000 but the latest data is at "
            "time 2.000000, when looking up transform from frame [b] to frame [a]",
        ),
        (
            "b",
            "a",
            0.5,
            tf2_py.ExtrapolationException,
            "Lookup would require extrapolation into the past.  Requested time 0.500000 but the earliest data is at "
            "time 1.000000, when looking up transform from frame [a] to frame [b]",
        ),
        (
            "a",
            "once",
            3,
            tf2_py.ExtrapolationException,
            "Lookup would require extrapolation at time 3.000000, but only time 1.000000 is in the buffer, when "
            "looking up transform from frame [once] to frame [a]",
        ),
    ],
)
def test_why_there_is_no_transform(target: str, source: str, time: float, kind: type[Exception], words: str) -> None:
    with pytest.raises(kind, match=f"^{re.escape(words)}$") as caught:
        filled().lookup_transform_core(target, source, at(time))
    assert isinstance(caught.value, tf2_py.TransformException)
    possible, reason = filled().can_transform_core(target, source, at(time))
    assert possible is False
    if kind in (tf2_py.ConnectivityException, tf2_py.ExtrapolationException):
        assert reason == words


@pytest.mark.parametrize(
    ("target", "source", "reason"),
    [
        ("no", "b", 'Invalid frame ID "no" passed to canTransform argument target_frame - frame does not exist'),
        ("a", "no", 'Invalid frame ID "no" passed to canTransform argument source_frame - frame does not exist'),
        (
            "",
            "b",
            'Invalid frame ID "" passed to canTransform argument target_frame - in tf2 frame_ids cannot be empty',
        ),
        (
            "/a",
            "b",
            'Invalid frame ID "/a" passed to canTransform argument target_frame - '
            "in tf2 frame_ids cannot start with a '/'",
        ),
    ],
)
def test_why_frames_cannot_be_looked_up(target: str, source: str, reason: str) -> None:
    assert filled().can_transform_core(target, source, at(1)) == (False, reason)


def test_frames_that_are_no_strings_are_type_errors() -> None:
    with pytest.raises(TypeError, match="must be a str, not int"):
        filled().lookup_transform_core(1, "a", LATEST)


def test_a_loop_is_an_error_and_not_a_hang() -> None:
    buffer = BufferCore()
    for parent, child in (("a", "b"), ("b", "c"), ("c", "a"), ("x", "y")):
        buffer.set_transform(transform(parent, child, SECOND), "me")
    for time in (LATEST, at(1)):
        for target, source in (("x", "a"), ("a", "x"), ("x", "b")):
            with pytest.raises(tf2_py.TransformException, match="contains a loop"):
                buffer.lookup_transform_core(target, source, time)
        assert buffer.can_transform_core("a", "c", time) == (True, "")


def test_an_ancestor_without_data_does_not_matter() -> None:
    buffer = BufferCore()
    for time in (1, 2, 3):
        buffer.set_transform(transform("base", "left", time * SECOND), "me")
        buffer.set_transform(transform("base", "right", time * SECOND), "me")
    buffer.set_transform(transform("map", "base", SECOND), "me")
    assert buffer.can_transform_core("left", "right", at(2.5)) == (True, "")
    assert buffer.can_transform_core("base", "right", at(2.5)) == (True, "")
    assert buffer.can_transform_core("map", "right", at(2.5))[0] is False


# What is refused


def test_slashes_before_names_are_dropped() -> None:
    buffer = BufferCore()
    buffer.set_transform(transform("/a", "/b", SECOND), "me")
    assert buffer.can_transform_core("a", "b", at(1)) == (True, "")


@pytest.mark.parametrize(
    ("message", "word"),
    [
        (transform("a", "a", 1), "TF_SELF_TRANSFORM"),
        (transform("/a", "a", 1), "TF_SELF_TRANSFORM"),
        (transform("", "b", 1), "TF_NO_FRAME_ID"),
        (transform("a", "", 1), "TF_NO_CHILD_FRAME_ID"),
        (transform("a", "/", 1), "TF_NO_CHILD_FRAME_ID"),
        (transform("a", "b", 1, (math.nan, 0.0, 0.0)), "TF_NAN_INPUT"),
        (transform("a", "b", 1, xyzw=(0.0, math.nan, 0.0, 1.0)), "TF_NAN_INPUT"),
        (transform("a", "b", 1, xyzw=(0.0, 0.0, 0.0, 0.0)), "TF_DENORMALIZED_QUATERNION"),
        (transform("a", "b", 1, xyzw=(0.0, 0.0, 0.0, 1.1)), "TF_DENORMALIZED_QUATERNION"),
    ],
)
@pytest.mark.parametrize("method", ["set_transform", "set_transform_static"])
def test_nonsense_is_ignored_with_an_error(
    message: object, word: str, method: str, capfd: pytest.CaptureFixture[str]
) -> None:
    buffer = BufferCore()
    getattr(buffer, method)(message, "somebody")
    shown = capfd.readouterr().err
    assert f"{word}: Ignoring transform" in shown
    assert '"somebody"' in shown
    assert buffer.all_frames_as_yaml() == "[]"


def test_infinite_coordinates_are_no_nonsense() -> None:
    buffer = BufferCore()
    buffer.set_transform(transform("a", "b", 1, (math.inf, -math.inf, 0.0)), "me")
    assert buffer.can_transform_core("a", "b", LATEST) == (True, "")


def test_whatever_looks_like_the_message_will_do() -> None:
    class Looks:
        pass

    real = transform("a", "b", SECOND, (1.0, 2.0, 3.0), (0.6, 0.0, 0.0, 0.8))
    alike = Looks()
    for name in ("header", "child_frame_id", "transform"):
        setattr(alike, name, getattr(real, name))
    buffer = BufferCore()
    buffer.set_transform(alike, "me")
    assert buffer.lookup_transform_core("a", "b", LATEST) == real
    alike.transform = Looks()
    alike.transform.translation, alike.transform.rotation = Quaternion(), real.transform.translation
    with pytest.raises(TypeError, match="must have x, y, z"):
        buffer.set_transform(alike, "me")
