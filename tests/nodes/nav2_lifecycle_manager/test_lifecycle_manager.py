"""The lifecycle manager, with nodes that note their transitions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from geometry_msgs.msg import Twist
from nav2_msgs.srv import ManageLifecycleNodes
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from std_srvs.srv import Trigger

from daidalos.nodes.nav2_lifecycle_manager.lifecycle_manager import LifecycleManager
from nodes.stepped import Stage

NAMES = ["first", "second", "third"]
Request = ManageLifecycleNodes.Request
UP = [*(f"configure {name}" for name in NAMES), *(f"activate {name}" for name in NAMES)]


class Managed(LifecycleNode):
    """A node that notes its transitions, and fails in those that it is told to fail in."""

    def __init__(self, name: str, log: list[str]) -> None:
        super().__init__(name)
        self.fails: set[str] = set()
        self._log = log

    def _take(self, transition: str) -> TransitionCallbackReturn:
        self._log.append(f"{transition} {self.get_name()}")
        return TransitionCallbackReturn.FAILURE if transition in self.fails else TransitionCallbackReturn.SUCCESS

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self._take("configure")

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self._take("activate")

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self._take("deactivate")

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self._take("cleanup")

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        return self._take("shutdown")


class Bench:
    """The manager and its nodes on a stage."""

    def __init__(self, stage: Stage, names: list[str] = NAMES) -> None:
        self.stage = stage
        self.log: list[str] = []
        self.nodes = {name: stage.add(Managed(name, self.log)) for name in names}
        self.manager = stage.add(LifecycleManager())

    def command(self, command: int) -> bool:
        response = self.stage.call(ManageLifecycleNodes, "/lifecycle_manager/manage_nodes", command=command)
        return bool(response.success)

    @property
    def is_active(self) -> bool:
        return bool(self.stage.call(Trigger, "/lifecycle_manager/is_active").success)

    @property
    def states(self) -> set[str]:
        return {node.current_state.label for node in self.nodes.values()}


def parameters(**more: Any) -> dict[str, Any]:
    return {"/lifecycle_manager": {"node_names": NAMES, **more}}


@pytest.fixture
def bench(stage: Callable[[dict[str, Any]], Stage]) -> Bench:
    return Bench(stage(parameters()))


def test_nodes_come_up_in_their_order_all_configured_before_the_first_is_activated(bench: Bench) -> None:
    bench.stage.step_for(0.5)
    assert bench.log == []
    assert not bench.is_active
    assert bench.command(Request.STARTUP)
    assert bench.log == UP
    assert bench.is_active


def test_it_starts_by_itself_where_it_is_asked_to(
    stage: Callable[[dict[str, Any]], Stage], capfd: pytest.CaptureFixture[str]
) -> None:
    bench = Bench(stage(parameters(autostart=True, bond_timeout=4.0)))
    bench.stage.step_until(lambda: bench.states == {"active"})
    assert bench.log == UP
    assert bench.is_active
    assert "Managed nodes are active" in capfd.readouterr().err


def test_a_node_that_comes_late_is_waited_for(
    stage: Callable[[dict[str, Any]], Stage], capfd: pytest.CaptureFixture[str]
) -> None:
    bench = Bench(stage(parameters(autostart=True)), ["first", "third"])
    bench.stage.step_for(1.0)
    assert bench.log == ["configure first"]
    assert "waiting for 'second'" in capfd.readouterr().err
    bench.stage.add(Managed("second", bench.log))
    bench.stage.step_until(lambda: len(bench.log) == len(UP))
    assert bench.log == UP


@pytest.mark.parametrize(
    ("transition", "log"),
    [("configure", UP[:2]), ("activate", UP[:5])],
)
def test_a_node_that_fails_keeps_the_others_from_being_started(
    bench: Bench, capfd: pytest.CaptureFixture[str], transition: str, log: list[str]
) -> None:
    bench.nodes["second"].fails = {transition}
    assert not bench.command(Request.STARTUP)
    assert bench.log == log
    assert not bench.is_active
    assert f"'second' did not {transition}" in capfd.readouterr().err
    bench.nodes["second"].fails = set()
    assert bench.command(Request.STARTUP)
    assert bench.states == {"active"}


def test_nodes_that_are_up_already_are_left_so(bench: Bench) -> None:
    bench.nodes["first"].trigger_configure()
    bench.nodes["first"].trigger_activate()
    bench.nodes["second"].trigger_configure()
    del bench.log[:]
    assert bench.command(Request.STARTUP)
    assert bench.log == ["configure third", "activate second", "activate third"]


def test_pause_and_resume(bench: Bench) -> None:
    bench.command(Request.STARTUP)
    del bench.log[:]
    assert bench.command(Request.PAUSE)
    assert bench.log == ["deactivate third", "deactivate second", "deactivate first"]
    assert not bench.is_active
    del bench.log[:]
    assert bench.command(Request.RESUME)
    assert bench.log == ["activate first", "activate second", "activate third"]
    assert bench.is_active


@pytest.mark.slow
@pytest.mark.parametrize("command", [Request.RESET, Request.SHUTDOWN])
def test_nodes_go_down_in_the_reverse_order(bench: Bench, command: int) -> None:
    bench.command(Request.STARTUP)
    del bench.log[:]
    assert bench.command(command)
    down = [f"{transition} {name}" for transition in ("deactivate", "cleanup") for name in reversed(NAMES)]
    assert bench.log == down
    assert bench.states == {"unconfigured"}
    assert not bench.is_active
    assert bench.command(Request.STARTUP)
    assert bench.is_active


def test_configure_and_clean_up_alone(bench: Bench) -> None:
    assert bench.command(Request.CONFIGURE)
    assert bench.log == UP[:3]
    assert not bench.is_active
    assert bench.command(Request.CLEANUP)
    assert bench.log[3:] == [f"cleanup {name}" for name in reversed(NAMES)]
    assert bench.states == {"unconfigured"}


def test_a_node_that_does_not_go_down_is_told_of(bench: Bench) -> None:
    bench.command(Request.STARTUP)
    bench.nodes["second"].fails = {"deactivate"}
    assert not bench.command(Request.PAUSE)
    assert [node.current_state.label for node in bench.nodes.values()] == ["active", "active", "inactive"]


def test_an_unknown_command_changes_nothing(bench: Bench, capfd: pytest.CaptureFixture[str]) -> None:
    bench.command(Request.STARTUP)
    assert not bench.command(77)
    assert bench.states == {"active"}
    assert bench.is_active
    assert "77" in capfd.readouterr().err


def test_no_nodes_are_up_at_once(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({"/lifecycle_manager": {"node_names": []}}), [])
    assert bench.command(Request.STARTUP)
    assert bench.is_active


class Driven:
    """What a robot is told on cmd_vel, and the node that drives it."""

    def __init__(self, stage: Stage) -> None:
        self.commands = stage.collect(Twist, "cmd_vel")
        stage.node.create_publisher(Twist, "cmd_vel", 10)


def test_when_a_node_ends_the_robot_stops_and_all_come_up_when_it_is_back(
    stage: Callable[[dict[str, Any]], Stage], capfd: pytest.CaptureFixture[str]
) -> None:
    bench = Bench(stage(parameters(autostart=True)))
    robot = Driven(bench.stage)
    bench.stage.step_until(lambda: bench.states == {"active"})
    del bench.log[:]
    bench.stage.remove(bench.nodes.pop("second"))
    bench.stage.step_until(lambda: bench.states == {"inactive"})
    assert bench.log == ["deactivate third", "deactivate first"]
    assert robot.commands
    assert all(command == Twist() for command in robot.commands)
    assert not bench.is_active
    assert "'second' is down: it has ended" in capfd.readouterr().err
    del bench.log[:]
    bench.nodes["second"] = bench.stage.add(Managed("second", bench.log))
    bench.stage.step_until(lambda: bench.states == {"active"})
    assert bench.log == ["configure second", "activate first", "activate second", "activate third"]
    assert bench.is_active


@pytest.mark.slow
def test_a_node_that_does_not_answer_is_down(
    stage: Callable[[dict[str, Any]], Stage], capfd: pytest.CaptureFixture[str]
) -> None:
    bench = Bench(stage(parameters(autostart=True, bond_timeout=0.4, attempt_respawn_reconnection=False)))
    bench.stage.step_until(lambda: bench.states == {"active"})
    bench.stage.suspend(bench.nodes["third"])
    errors = ""

    def is_noted() -> bool:
        nonlocal errors
        errors += capfd.readouterr().err
        return "'third' is down: it has not answered for 0.4 s" in errors

    bench.stage.step_until(is_noted)
    bench.stage.step_until(lambda: bench.nodes["first"].current_state.label == "inactive")


@pytest.mark.slow
def test_a_node_that_stays_away_is_named(
    stage: Callable[[dict[str, Any]], Stage], capfd: pytest.CaptureFixture[str]
) -> None:
    bench = Bench(stage(parameters(autostart=True, bond_respawn_max_duration=0.3)))
    bench.stage.step_until(lambda: bench.states == {"active"})
    bench.stage.remove(bench.nodes.pop("first"))
    errors = ""

    def is_noted() -> bool:
        nonlocal errors
        errors += capfd.readouterr().err
        return "not back within 0.3 s: first" in errors

    bench.stage.step_until(is_noted)
    assert bench.states == {"inactive"}


def test_nodes_that_were_paused_are_not_watched(bench: Bench, capfd: pytest.CaptureFixture[str]) -> None:
    bench.command(Request.STARTUP)
    bench.command(Request.PAUSE)
    bench.stage.remove(bench.nodes.pop("first"))
    bench.stage.step_for(1.0)
    assert "is down" not in capfd.readouterr().err
