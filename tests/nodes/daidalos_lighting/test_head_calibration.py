"""The node `head_calibration`: commands, a game pad, sessions that are resumed, and what is drawn."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from daidalos_msgs.msg import HeadCalibration as State
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import Joy
from std_msgs.msg import String
from visualization_msgs.msg import Marker, MarkerArray

from daidalos.common.errors import UserError
from daidalos.nodes.daidalos_lighting.head_calibration import HeadCalibration
from daidalos.nodes.qos import LATCHED


class Guide:
    """The node, and someone who commands it."""

    def __init__(self, node: Node, folder: Path, **values: Any) -> None:
        (folder / "lights.yaml").write_text("heads: [{name: spot}]\noutputs: []\n")
        values = {"config": str(folder / "lights.yaml"), "output": str(folder / "result.yaml"), **values}
        given: list[Parameter[Any]] = [Parameter(name, value=value) for name, value in values.items()]
        self.calibration = HeadCalibration(parameter_overrides=given)
        self.states, self.markers = list[State](), list[MarkerArray]()
        node.create_subscription(State, "/head_calibration/state", self.states.append, LATCHED)
        node.create_subscription(MarkerArray, "/head_calibration/markers", self.markers.append, 100)
        self._commands = node.create_publisher(String, "/head_calibration/command", 100)
        self.pad = node.create_publisher(Joy, "/joy", 10)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.calibration)
        self._executor.add_node(node)

    def send(self, *commands: str) -> State:
        """Send commands, and return the state after the last."""
        for command in commands:
            count = len(self.states)
            self._commands.publish(String(data=command))
            self.until(lambda count=count: len(self.states) > count)  # type: ignore[misc]
        return self.states[-1]

    def until(self, holds: Callable[[], bool]) -> None:
        """Spin until a condition holds."""
        end = time.monotonic() + 20.0
        while not holds():
            assert time.monotonic() < end, self.states[-1:]
            self._executor.spin_once(timeout_sec=0.02)


@pytest.fixture
def start(node: Node, tmp_path: Path) -> Iterator[Callable[..., Guide]]:
    made = list[Guide]()

    def begin(**values: Any) -> Guide:
        made.append(Guide(node, tmp_path, **values))
        return made[-1]

    yield begin
    for one in made:
        one.calibration.destroy_node()


def test_directions_are_confirmed_taken_back_and_written(start: Callable[..., Guide], tmp_path: Path) -> None:
    guide = start()
    first = guide.send("up")
    assert (first.confirmed, first.total, first.head) == (0, 8, "spot")
    assert (first.point.x, first.point.y, first.point.z) == (-1.0, -0.75, 0.0)
    assert guide.send("left").pan == pytest.approx(first.pan - first.step)
    assert guide.send("-").step < first.step
    assert "means nothing" in guide.send("sideways").report
    assert "no result" in guide.send("propose").report
    assert "no result" in guide.send("write").report or guide.states[-1].report
    guide.send("+", "right", "down")  # where it aimed at first
    assert guide.send("enter").confirmed == 1
    assert guide.send("undo").confirmed == 0
    last = guide.send(*["enter"] * 8)
    assert last.is_complete
    assert last.has_result
    assert [round(one, 6) for one in last.values[:3]] == [0.0, 0.0, 2.8]
    assert len(last.expected_errors) == 7 * last.columns
    tiles = [one for one in guide.markers[-1].markers if one.type == Marker.CUBE_LIST]
    assert len(tiles[0].points) == len(tiles[0].colors) == len(last.expected_errors)
    assert guide.send("propose").total == 9
    assert guide.send("enter", "write").is_written
    assert (tmp_path / "result.yaml").is_file()
    assert not (tmp_path / "result.yaml.session").exists()


def test_a_session_is_resumed(start: Callable[..., Guide]) -> None:
    guide = start()
    guide.send("enter", "enter", "enter")
    guide.calibration.destroy_node()
    again = start()
    again.until(lambda: any(state.report.startswith("resumed from") for state in again.states))
    assert again.states[-1].confirmed == 3


def test_a_game_pad_turns_and_confirms(start: Callable[..., Guide]) -> None:
    guide = start()
    before = guide.send("left")
    guide.pad.publish(Joy(axes=[-1.0, 0.05], buttons=[0, 0]))
    guide.until(lambda: guide.states[-1].pan > before.pan + before.step)
    assert guide.states[-1].tilt == before.tilt  # within the dead zone
    guide.pad.publish(Joy(axes=[0.0, 0.0], buttons=[1, 0]))
    guide.pad.publish(Joy(axes=[0.0, 0.0], buttons=[1, 0]))
    guide.until(lambda: guide.states[-1].confirmed == 1)
    guide.pad.publish(Joy(axes=[], buttons=[0, 1]))
    guide.until(lambda: guide.states[-1].confirmed == 0)


@pytest.mark.usefixtures("graph")
@pytest.mark.parametrize(
    ("values", "problem"),
    [
        ({"table": [0.0, 0.0, 0.0, 1.0, 0.0]}, "two different corners"),
        ({"table": [math.nan, 0.0, 1.0, 1.0, 0.0]}, "two different corners"),
        ({"points": "no.yaml"}, "no.yaml"),
        ({"head": "sopt"}, "there is no head 'sopt'"),
    ],
)
def test_faults_of_parameters_are_named(node: Node, tmp_path: Path, values: dict[str, Any], problem: str) -> None:
    with pytest.raises(UserError, match=problem):
        Guide(node, tmp_path, **values)
