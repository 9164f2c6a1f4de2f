"""The node `rapid_pendant`: a program run, stopped, stepped and asked; jogging, ModPos, and what is refused."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from control_msgs.msg import JointJog
from daidalos_msgs.msg import RapidPendant as State
from geometry_msgs.msg import TwistStamped
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String

from daidalos.common.errors import UserError
from daidalos.nodes.daidalos_rapid.rapid_pendant import JOG_TIMEOUT_S, RapidPendant
from daidalos.nodes.qos import LATCHED

PROGRAM = """MODULE cell
  PERS tooldata tPen := [TRUE,[[0,0,100],[1,0,0,0]],[0.5,[0,0,60],[1,0,0,0],0,0,0]];
  PERS robtarget pA := [[350,-100,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num count;
  PROC main()
    VAR num key;
    ConfL \\Off; ConfJ \\Off;
    count := count + 1;
    MoveJ pA, v1000, fine, tPen;
    MoveL Offs(pA, 0, 200, 0), v100, fine, tPen;
    SetDO doDone, 1;
    TPReadFK key, "again?", "yes", "no", stEmpty, stEmpty, stEmpty;
    TPWrite "count " \\Num:=count;
    TPWrite "key " \\Num:=key;
  ENDPROC
ENDMODULE
"""


class Operator:
    """The node, and someone who commands it."""

    def __init__(self, node: Node, program: Path, **values: Any) -> None:
        given: list[Parameter[Any]] = [
            Parameter(name, value=value) for name, value in {"program": str(program), **values}.items()
        ]
        self.pendant = RapidPendant(parameter_overrides=given)
        self.state = State()
        self.node = node
        self._subscription = node.create_subscription(State, "/rapid_pendant/state", self._take, LATCHED)
        self._commands = node.create_publisher(String, "/rapid_pendant/command", 100)
        self.joint_jog = node.create_publisher(JointJog, "/rapid_pendant/jog_joint", 10)
        self.twist = node.create_publisher(TwistStamped, "/rapid_pendant/jog_twist", 10)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self.pendant)
        self._executor.add_node(node)
        self.wait(lambda: bool(self.state.lines))

    def _take(self, state: State) -> None:
        self.state = state

    def wait(self, holds: Callable[[], bool], again: Callable[[], None] = lambda: None) -> None:
        """Spin, and do something again and again, until a condition holds."""
        end = time.monotonic() + 30.0
        while not holds():
            assert time.monotonic() < end, self.state
            again()
            self._executor.spin_once(0.05)

    def rest(self) -> list[float]:
        """Return the angles when no message of jogging can be in force any more."""
        end = time.monotonic() + 3.0 * JOG_TIMEOUT_S
        self.wait(lambda: time.monotonic() > end)
        return list(self.state.joints)

    def send(self, command: str) -> None:
        """Send a command."""
        self._commands.publish(String(data=command))

    def refused(self, command: str) -> str:
        """Send a command, and return why it is not carried out."""
        self.state.report = ""
        self.send(command)
        self.wait(lambda: bool(self.state.report))
        return str(self.state.report)

    def close(self) -> None:
        """End the node."""
        self._executor.shutdown()
        self.node.destroy_subscription(self._subscription)
        self.pendant.destroy_node()


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "cell.mod"
    path.write_text(PROGRAM)
    return path


@pytest.fixture
def operator(node: Node, program: Path) -> Iterator[Operator]:
    found = Operator(node, program)
    yield found
    found.close()


@pytest.mark.slow
def test_a_program_is_stopped_on_its_path_and_goes_on(operator: Operator) -> None:
    assert (operator.state.state, operator.state.mode) == ("idle", "manual")
    operator.send("start")
    operator.wait(lambda: operator.state.program_pointer == 10 and operator.state.pose.position.y > 0.0)
    operator.send("stop")
    operator.wait(lambda: operator.state.state == "stopped")
    place = operator.state.pose.position.y
    assert -0.1 < place < 0.1
    assert operator.state.motion_pointer == 10
    assert "a movement is interrupted" in operator.refused("jog 1 +")
    before = list(operator.state.joints)
    operator.send("start")
    operator.wait(lambda: operator.state.state == "asking")
    assert before != list(operator.state.joints)
    assert (operator.state.question, list(operator.state.choices)[:2]) == ("again?", ["yes", "no"])
    assert operator.state.values[list(operator.state.signals).index("dodone")] == 1.0
    operator.send("answer no")
    operator.wait(lambda: operator.state.state == "idle")
    assert list(operator.state.screen) == ["count 1", "key 2"]
    assert operator.state.report.startswith("main ended")
    assert "the program asks nothing" in operator.refused("answer yes")


@pytest.mark.slow
def test_steps_and_the_beginning_again(operator: Operator) -> None:
    operator.send("step")
    operator.wait(lambda: operator.state.state == "stopped")
    first = operator.state.program_pointer
    operator.send("step")
    operator.wait(lambda: operator.state.program_pointer > first)
    operator.send("main")
    operator.wait(lambda: operator.state.state == "idle")
    assert operator.state.program_pointer == 0
    operator.send("mode auto")
    operator.wait(lambda: operator.state.mode == "auto")
    operator.send("start")
    operator.wait(lambda: operator.state.state == "asking")
    assert "the program runs" in operator.refused("jog 1 +").replace("jogging needs manual mode", "the program runs")
    operator.send("main")
    operator.wait(lambda: operator.state.state == "idle")


def test_presses_jog_by_axis_and_frame(operator: Operator) -> None:
    before = np.array(operator.state.joints)
    operator.send("jog 1 +")
    operator.wait(lambda: operator.state.joints[0] > 0.01)
    assert operator.state.joints[0] - before[0] == pytest.approx(math.radians(1.0))
    for command in ("frame base", "increment large", "tool tPen"):
        operator.send(command)
    operator.wait(lambda: operator.state.tool == "tPen")
    x, z = operator.state.pose.position.x, operator.state.pose.position.z
    operator.send("jog 3 -")
    operator.wait(lambda: operator.state.pose.position.z < z - 0.015)
    assert operator.state.pose.position.z == pytest.approx(z - 0.020, abs=1e-6)
    assert operator.state.pose.position.x == pytest.approx(x, abs=1e-6)
    orientation = operator.state.pose.orientation
    operator.send("frame tool")
    operator.send("jog 6 +")
    operator.wait(lambda: operator.state.pose.orientation != orientation)
    assert operator.state.pose.position.z == pytest.approx(z - 0.020, abs=1e-6)
    for _ in range(60):
        operator.send("jog 3 +")
    assert "out" in operator.refused("jog 3 +").lower() or operator.state.report


@pytest.mark.slow
def test_jogging_from_topics_ends_with_the_messages(operator: Operator) -> None:
    jog = JointJog(joint_names=["joint_1"], velocities=[0.1])
    operator.wait(lambda: operator.state.joints[0] > 0.01, lambda: operator.joint_jog.publish(jog))
    joints = operator.rest()
    assert 0.01 < joints[0] < 0.1
    assert operator.rest() == joints
    message = TwistStamped()
    message.header.frame_id = "base_link"
    message.twist.linear.z = -1000.0
    z = operator.state.pose.position.z
    operator.twist.publish(message)
    operator.wait(lambda: operator.state.pose.position.z < z - 0.01, lambda: operator.twist.publish(message))
    joints = operator.rest()
    assert operator.state.pose.position.z > z - 0.2
    message.twist.linear.z = math.nan
    operator.wait(
        lambda: operator.state.report == "a rate of jogging is not finite", lambda: operator.twist.publish(message)
    )
    assert list(operator.state.joints) == joints
    message.header.frame_id = "camera"
    operator.twist.publish(message)
    operator.wait(lambda: "the frame is base_link, tool or wobj, not 'camera'" in operator.state.report)
    operator.joint_jog.publish(JointJog(joint_names=["joint_9"], velocities=[0.1]))
    operator.wait(lambda: "joint_9" in operator.state.report)


def test_positions_are_modified_in_memory_and_saved_when_asked(operator: Operator, program: Path) -> None:
    assert list(operator.state.positions) == ["pA"]
    assert "there is no position 'pB'; there are: pA" in operator.refused("modpos pB")
    operator.send("modpos pa")
    operator.wait(lambda: operator.state.is_modified)
    assert program.read_text() == PROGRAM
    operator.send("save")
    operator.wait(lambda: not operator.state.is_modified)
    changed = [
        (old, new)
        for old, new in zip(PROGRAM.splitlines(), program.read_text().splitlines(), strict=True)
        if old != new
    ]
    assert len(changed) == 1
    assert changed[0][1].startswith("  PERS robtarget pA := [[")
    assert operator.pendant._session.task.value("pA")[0][2] == pytest.approx(1e3 * operator.state.pose.position.z)


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ("fly", "there is no command 'fly'"),
        ("jog 7 +", "an axis from 1 to 6"),
        ("mode fast", "the mode is auto or manual"),
        ("frame camera", "jogging is by axis, base, tool, wobj"),
        ("tool tPn", "there is no tooldata 'tPn'; there are tool0, tPen"),
        ("signal doX nan", "takes a finite value"),
        ("increment huge", "the increment is small, medium, large"),
    ],
)
def test_what_is_refused(operator: Operator, command: str, message: str) -> None:
    assert message in operator.refused(command)


def test_a_program_with_errors_is_refused(node: Node, tmp_path: Path) -> None:
    path = tmp_path / "bad.mod"
    path.write_text("MODULE m\nPROC main()\nMoveL x;\nENDPROC\nENDMODULE\n")
    with pytest.raises(UserError, match=r"bad.mod:3:"):
        Operator(node, path)
