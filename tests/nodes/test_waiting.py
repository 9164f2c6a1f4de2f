"""Waits for what may still come."""

import os
import subprocess
import sys
import threading
from typing import Any

import pytest
from rclpy.node import Node
from std_srvs.srv import Trigger

from daidalos.common.errors import UserError
from daidalos.nodes import manager_calls, waiting
from ros.graph import graph, node, spinning  # noqa: F401

MANAGER = "/controller_manager"
LIST = f"{MANAGER}/list_controllers"


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DAIDALOS_LAUNCH_PID", raising=False)
    for module in (waiting, manager_calls):
        monkeypatch.setattr(module, "REPORT_S", 0.2)


def ask(node: Node, report: Any, **limits: Any) -> Any:  # noqa: F811
    return manager_calls.call_manager(node, Trigger, MANAGER, "list_controllers", Trigger.Request(), report, **limits)


def test_nobody_waits_where_nothing_will_bring_the_manager(node: Node) -> None:  # noqa: F811
    with pytest.raises(UserError, match="no controller manager '/controller_manager', and no simulator is running"):
        ask(node, pytest.fail)


def test_a_manager_of_another_name_is_told(node: Node) -> None:  # noqa: F811
    node.create_service(Trigger, "/arm/controller_manager/list_controllers", lambda request, response: response)
    with pytest.raises(UserError, match="did you mean '/arm/controller_manager'"):
        ask(node, pytest.fail)


@pytest.mark.parametrize("bringer", ["simulator", "launch"])
def test_the_manager_is_waited_for_while_something_may_bring_it(
    node: Node,  # noqa: F811
    bringer: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if bringer == "simulator":
        node.create_service(Trigger, "/spawn_entity", lambda request, response: response)
    else:
        monkeypatch.setenv("DAIDALOS_LAUNCH_PID", str(os.getpid()))
    reports: list[str] = []

    def bring(text: str) -> None:
        reports.append(text)
        if len(reports) == 2:
            node.create_service(Trigger, LIST, lambda request, response: Trigger.Response(message="here"))

    with spinning(node):
        assert ask(node, bring).message == "here"
    assert reports[0].startswith(f"waiting for '{MANAGER}', as the {bringer}")


def test_a_launch_that_has_ended_brings_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    with subprocess.Popen([sys.executable, "-c", ""]) as ended:
        ended.wait()
    monkeypatch.setenv("DAIDALOS_LAUNCH_PID", str(ended.pid))
    assert not waiting.launch_is_running()
    assert not waiting.wait_in_launch(lambda limit_s: False, 0.1, pytest.fail)


def test_a_limit_that_is_given_holds_in_a_launch_too(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.setenv("DAIDALOS_LAUNCH_PID", str(os.getpid()))
    with pytest.raises(UserError, match=r"there was no controller manager '/controller_manager' within 0\.1 s"):
        ask(node, pytest.fail, coming_s=0.1)


def test_a_late_answer_is_waited_for_while_the_server_is_there(node: Node) -> None:  # noqa: F811
    reported = threading.Event()

    def serve(request: Any, response: Any) -> Any:
        assert reported.wait(20.0)
        return Trigger.Response(message="late")

    node.create_service(Trigger, LIST, serve)
    with spinning(node):
        assert ask(node, lambda text: reported.set()).message == "late"


def test_an_answer_may_have_a_limit(node: Node) -> None:  # noqa: F811
    done = threading.Event()

    def serve(request: Any, response: Any) -> Any:
        done.wait(20.0)
        return response

    node.create_service(Trigger, LIST, serve)
    with spinning(node):
        with pytest.raises(UserError, match=f"{LIST} did not answer within 0.1 s"):
            ask(node, pytest.fail, answer_s=0.1)
        done.set()


def test_a_program_of_a_launch_knows_the_launch() -> None:
    from launch import LaunchDescription, LaunchService
    from launch.actions import ExecuteProcess

    code = "import os,sys; sys.exit(int(os.environ['DAIDALOS_LAUNCH_PID']) != os.getppid())"
    process = ExecuteProcess(cmd=[sys.executable, "-c", code])
    service = LaunchService(noninteractive=True)
    service.include_launch_description(LaunchDescription([process]))
    assert service.run() == 0
    assert process.return_code == 0
