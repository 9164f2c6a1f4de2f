"""Managed nodes."""

from collections.abc import Callable
from typing import Any

import pytest
from lifecycle_msgs.msg import Transition, TransitionEvent
from lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetAvailableTransitions, GetState
from rclpy.context import Context
from rclpy.impl.errors import RCLError
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from std_msgs.msg import String

from ros.rclpy.waiting import executor_of, run_ready

SUCCESS, FAILURE, ERROR = TransitionCallbackReturn


class Recorder(LifecycleNode):
    """Notes what it is asked, and answers as it was told."""

    def __init__(self, **answers: Any) -> None:
        self.asked: list[tuple[str, str]] = []
        self._answers = answers
        super().__init__("managed", enable_communication_interface=False)

    def _answer(self, callback: str, state: LifecycleState) -> Any:
        self.asked.append((callback, state.label))
        answer = self._answers.get(callback, SUCCESS)
        if isinstance(answer, Exception):
            raise answer
        return answer


def _answering(callback: str) -> Callable[[Recorder, LifecycleState], Any]:
    return lambda self, state: self._answer(callback, state)


for _name in ("configure", "cleanup", "activate", "deactivate", "shutdown", "error"):
    setattr(Recorder, f"on_{_name}", _answering(_name))


def state_of(node: LifecycleNode) -> str:
    return node._state_machine.current_state[1]


def test_a_node_goes_through_its_states(graph: Context) -> None:
    node = Recorder()
    for trigger, before, after in (
        ("configure", "unconfigured", "inactive"),
        ("cleanup", "inactive", "unconfigured"),
        ("configure", "unconfigured", "inactive"),
        ("activate", "inactive", "active"),
        ("deactivate", "active", "inactive"),
        ("shutdown", "inactive", "finalized"),
    ):
        assert state_of(node) == before
        assert getattr(node, f"trigger_{trigger}")() == SUCCESS
        assert state_of(node) == after
        assert node.asked[-1] == (trigger, before)
    with pytest.raises(RCLError, match="finalized"):
        node.trigger_configure()


@pytest.mark.parametrize(
    ("answers", "outcome", "state"),
    [
        ({"configure": FAILURE}, FAILURE, "unconfigured"),
        ({"configure": ERROR}, ERROR, "unconfigured"),
        ({"configure": ERROR, "error": ERROR}, ERROR, "finalized"),
        ({"configure": ERROR, "error": FAILURE}, ERROR, "finalized"),
        ({"configure": ZeroDivisionError()}, ERROR, "unconfigured"),
        ({"configure": "no answer"}, ERROR, "unconfigured"),
    ],
)
def test_a_transition_may_go_wrong(graph: Context, answers: dict[str, Any], outcome: Any, state: str) -> None:
    node = Recorder(**answers)
    assert node.trigger_configure() == outcome
    assert state_of(node) == state


def test_publishers_work_while_the_node_is_active(graph: Context) -> None:
    node = LifecycleNode("managed")
    received: list[str] = []
    node.create_subscription(String, "topic", lambda message: received.append(message.data), 10)
    publisher = node.create_lifecycle_publisher(String, "topic", 10)

    def publish(text: str) -> None:
        publisher.publish(String(data=text))
        run_ready(executor)

    executor = executor_of(node)
    publish("before")
    node.trigger_configure()
    node.trigger_activate()
    assert publisher.is_activated
    publish("meanwhile")
    node.trigger_deactivate()
    publish("after")
    assert received == ["meanwhile"]
    assert node.destroy_lifecycle_publisher(publisher)
    with pytest.raises(TypeError):
        node.create_lifecycle_publisher(String, "topic", 10, publisher_class=object)


def test_others_may_ask_for_transitions(graph: Context) -> None:
    node = LifecycleNode("managed")
    executor = executor_of(node)
    told: list[tuple[str, str]] = []
    node.create_subscription(
        TransitionEvent,
        "managed/transition_event",
        lambda event: told.append((event.transition.label, event.goal_state.label)),
        10,
    )

    def ask(kind: Any, name: str, **fields: Any) -> Any:
        client = node.create_client(kind, f"/managed/{name}")
        future = client.call_async(kind.Request(**fields))
        executor.spin_until_future_complete(future, 10)
        return future.result()

    assert ask(GetState, "get_state").current_state.label == "unconfigured"
    configure = Transition(id=Transition.TRANSITION_CONFIGURE)
    assert ask(ChangeState, "change_state", transition=configure).success
    assert not ask(ChangeState, "change_state", transition=configure).success
    assert ask(GetState, "get_state").current_state.label == "inactive"
    assert len(ask(GetAvailableStates, "get_available_states").available_states) == 11
    possible = ask(GetAvailableTransitions, "get_available_transitions").available_transitions
    assert {one.transition.label for one in possible} == {"activate", "cleanup", "shutdown"}
    every = ask(GetAvailableTransitions, "get_transition_graph").available_transitions
    assert len({one.transition.label for one in every}) == 8
    assert told == [("configure", "configuring"), ("transition_success", "inactive")]


def test_a_node_may_keep_to_itself(graph: Context) -> None:
    node = LifecycleNode("managed", enable_communication_interface=False)
    assert node._state_machine.service_change_state is None
    assert "/managed/get_state" not in dict(node.get_service_names_and_types())
    with pytest.raises(TypeError, match="bool"):
        LifecycleNode("managed", enable_communication_interface="yes")
