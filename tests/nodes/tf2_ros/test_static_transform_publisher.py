"""The command line of `static_transform_publisher`, in both styles."""

import math

import pytest

from daidalos.nodes.runner import UserError
from daidalos.nodes.tf2_ros.static_transform_publisher import parse


def rotation(parameters: dict[str, object]) -> list[object]:
    return [parameters[f"rotation.{axis}"] for axis in "xyzw"]


def test_new_style() -> None:
    numbers = ["--x", "1", "--y", "-0.5", "--z", "-1e-3", "--yaw", "1.5707963267948966"]
    words = [*numbers, "--frame-id", "map", "--child-frame-id", "odom"]
    parameters = parse(words)
    assert [parameters[f"translation.{axis}"] for axis in "xyz"] == [1.0, -0.5, -1e-3]
    half = math.sqrt(0.5)
    assert rotation(parameters) == pytest.approx([0.0, 0.0, half, half])
    assert (parameters["frame_id"], parameters["child_frame_id"]) == ("map", "odom")


def test_new_style_with_a_quaternion() -> None:
    parameters = parse(["--qx", "1", "--qw", "0", "--frame-id=a", "--child-frame-id=b"])
    assert rotation(parameters) == [1.0, 0.0, 0.0, 0.0]


def test_without_numbers_it_is_the_identity() -> None:
    parameters = parse(["--frame-id", "a", "--child-frame-id", "b"])
    assert rotation(parameters) == [0.0, 0.0, 0.0, 1.0]


def test_old_style_with_angles(capsys: pytest.CaptureFixture[str]) -> None:
    parameters = parse(["1", "2", "3", "0.5", "0.1", "-1.0", "foo", "bar"])
    assert [parameters[f"translation.{axis}"] for axis in "xyz"] == [1.0, 2.0, 3.0]
    # What ROS 2's documentation shows for this very line.
    assert rotation(parameters) == pytest.approx([-0.475, -0.076, 0.240, 0.843], abs=5e-4)
    assert "Old-style arguments are deprecated" in capsys.readouterr().err


def test_old_style_with_a_quaternion() -> None:
    parameters = parse(["0", "0", "-1", "0", "0", "0", "1", "foo", "bar"])
    assert parameters["translation.z"] == -1.0
    assert rotation(parameters) == [0.0, 0.0, 0.0, 1.0]
    assert (parameters["frame_id"], parameters["child_frame_id"]) == ("foo", "bar")


def test_what_is_no_number_is_named() -> None:
    with pytest.raises(UserError, match="yaw must be a number, not 'left'"):
        parse(["1", "2", "3", "left", "0", "0", "foo", "bar"])
    with pytest.raises(UserError, match="x must be a number, not 'far'"):
        parse(["--x", "far", "--frame-id", "a", "--child-frame-id", "b"])


@pytest.mark.parametrize(
    "words",
    [[], ["--frame-id", "a"], ["1", "2"], ["--qx", "1", "--yaw", "1", "--frame-id", "a", "--child-frame-id", "b"]],
)
def test_what_is_missing_or_too_much_is_said(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        parse(words)
    assert ended.value.code == 255
    assert "error:" in capsys.readouterr().err
