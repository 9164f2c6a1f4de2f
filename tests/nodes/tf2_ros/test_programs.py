"""The programs of tf2_ros, as a course runs them."""

from __future__ import annotations

import pytest

from nodes.terminal import Terminal

pytestmark = pytest.mark.slow

_BOX = ("run", "tf2_ros", "static_transform_publisher", "1", "2", "3", "0.5", "0.1", "-1.0", "foo", "bar")


def test_echo_waits_and_shows(domain: int) -> None:
    with Terminal("run", "tf2_ros", "tf2_echo", "foo", "bar", domain=domain) as echo:
        echo.wait_for(
            r'\[tf2_echo\]: Waiting for transform foo ->  bar: Invalid frame ID "foo" passed to canTransform argument '
            "target_frame - frame does not exist"
        )
        with Terminal(*_BOX, domain=domain) as publisher:
            publisher.wait_for("Spinning until stopped - publishing transform")
            publisher.wait_for(r"translation: \('1.000000', '2.000000', '3.000000'\)")
            publisher.wait_for("from 'foo' to 'bar'")
            first = echo.lines.index(echo.wait_for("At time 0.0")[0])
            echo.wait_for("At time 0.0", 2)
            assert echo.lines[first + 1 : first + 10] == [
                "- Translation: [1.000, 2.000, 3.000]",
                "- Rotation: in Quaternion [-0.475, -0.076, 0.240, 0.843]",
                "- Rotation: in RPY (radian) [-1.000, 0.100, 0.500]",
                "- Rotation: in RPY (degree) [-57.296, 5.730, 28.648]",
                "- Matrix:",
                "  0.873 -0.333 -0.356  1.000",
                "  0.477  0.434  0.764  2.000",
                " -0.100 -0.837  0.538  3.000",
                "  0.000  0.000  0.000  1.000",
            ]
            assert publisher.interrupt() == 0
        assert echo.interrupt() == 0


def test_parameters_of_the_publisher_are_to_be_read_only(domain: int) -> None:
    with Terminal(*_BOX, "--ros-args", "-r", "__node:=box", domain=domain) as publisher:
        publisher.wait_for(r"\[box\]: Spinning until stopped")
        with Terminal("param", "get", "/box", "translation.y", domain=domain) as command:
            command.wait_for("Double value is: 2.0")
        with Terminal("param", "set", "/box", "translation.y", "5.0", domain=domain) as command:
            command.wait_for("Setting parameter failed")
        assert publisher.interrupt() == 0


def test_monitor(domain: int) -> None:
    with (
        Terminal("run", "turtle_tf2_py", "fixed_frame_tf2_broadcaster", domain=domain) as broadcaster,
        Terminal("run", "tf2_ros", "tf2_monitor", domain=domain) as everything,
        Terminal("run", "tf2_ros", "tf2_monitor", "turtle1", "carrot1", domain=domain) as chain,
    ):
        everything.wait_for("Gathering data on all frames for 10 seconds...")
        everything.wait_for("RESULTS: for all Frames")
        everything.wait_for("Frame: carrot1, published by <no authority available>, Average Delay: ")
        rate = float(everything.wait_for("Node: <no authority available> ")[0].split()[4])
        assert rate == pytest.approx(10.0, rel=0.1)
        chain.wait_for("RESULTS: for turtle1 to carrot1")
        chain.wait_for("Chain is: turtle1 -> carrot1")
        chain.wait_for("Net delay     avg = ")
        for program in (chain, everything, broadcaster):
            assert program.interrupt() == 0


def test_wrong_use_is_explained(domain: int) -> None:
    with Terminal("run", "tf2_ros", "tf2_echo", "foo", domain=domain) as echo:
        assert echo.wait(30) == 255
        assert "Usage: tf2_echo source_frame target_frame [echo_rate]" in echo.text
    with Terminal("run", "tf2_ros", "tf2_echo", "foo", "bar", "0", domain=domain) as echo:
        assert echo.wait(30) == 2
        assert "Echo rate must be > 0.0" in echo.text
    words = ("--frame-id", "a", "--child-frame-id", "a")
    with Terminal("run", "tf2_ros", "static_transform_publisher", *words, domain=domain) as publisher:
        assert publisher.wait(30) == 2
        assert "cannot publish static transform from 'a' to 'a'" in publisher.text
