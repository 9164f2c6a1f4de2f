"""Services and actions that tell of what passes them."""

from typing import Any

import pytest
from example_interfaces.srv import AddTwoInts
from rclpy.action import ActionClient, ActionServer
from rclpy.node import Node
from rclpy.qos import qos_profile_system_default
from rclpy.service_introspection import ServiceIntrospectionState
from service_msgs.msg import ServiceEventInfo
from test_msgs.action import Fibonacci

from ros.rclpy.waiting import executor_of, run_ready, spin_until

KINDS = [
    ServiceEventInfo.REQUEST_SENT,
    ServiceEventInfo.REQUEST_RECEIVED,
    ServiceEventInfo.RESPONSE_SENT,
    ServiceEventInfo.RESPONSE_RECEIVED,
]


def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
    response.sum = request.a + request.b
    return response


@pytest.mark.parametrize("state", ServiceIntrospectionState)
def test_every_step_of_a_call_is_told(node: Node, state: ServiceIntrospectionState) -> None:
    executor = executor_of(node)
    service, client = node.create_service(AddTwoInts, "add", add), node.create_client(AddTwoInts, "add")
    events: list[Any] = []
    node.create_subscription(AddTwoInts.Event, "add/_service_event", events.append, 10)
    for entity in (service, client):
        entity.configure_introspection(node.get_clock(), qos_profile_system_default, ServiceIntrospectionState.METADATA)
        entity.configure_introspection(node.get_clock(), qos_profile_system_default, state)
    future = client.call_async(AddTwoInts.Request(a=2, b=3))
    executor.spin_until_future_complete(future, 10)
    run_ready(executor)
    if state is ServiceIntrospectionState.OFF:
        assert events == []
        assert node.count_publishers("add/_service_event") == 0
        return
    assert sorted(event.info.event_type for event in events) == sorted(KINDS)
    assert len({(event.info.sequence_number, bytes(event.info.client_gid)) for event in events}) == 1
    assert all(event.info.stamp.sec > 0 for event in events)
    with_contents = state is ServiceIntrospectionState.CONTENTS
    for event in events:
        is_request = event.info.event_type in KINDS[:2]
        assert [one.a for one in event.request] == ([2] if with_contents and is_request else [])
        assert [one.sum for one in event.response] == ([5] if with_contents and not is_request else [])


def test_actions_tell_of_their_services(node: Node) -> None:
    executor = executor_of(node)

    def execute(goal: Any) -> Fibonacci.Result:
        goal.succeed()
        return Fibonacci.Result(sequence=[1, 1])

    server = ActionServer(node, Fibonacci, "fibonacci", execute)
    client = ActionClient(node, Fibonacci, "fibonacci")
    told: dict[str, list[int]] = {"send_goal": [], "get_result": []}
    services = {"send_goal": Fibonacci.Impl.SendGoalService, "get_result": Fibonacci.Impl.GetResultService}
    for name, service in services.items():
        node.create_subscription(
            service.Event,
            f"fibonacci/_action/{name}/_service_event",
            lambda event, name=name: told[name].append(event.info.event_type),
            10,
        )
    for entity in (server, client):
        entity.configure_introspection(node.get_clock(), qos_profile_system_default, ServiceIntrospectionState.CONTENTS)
    goal = client.send_goal_async(Fibonacci.Goal(order=2))
    executor.spin_until_future_complete(goal, 10)
    executor.spin_until_future_complete(goal.result().get_result_async(), 10)
    spin_until(executor, lambda: all(len(kinds) == 4 for kinds in told.values()))
    assert all(sorted(kinds) == sorted(KINDS) for kinds in told.values())
