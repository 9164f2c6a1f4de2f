"""Following the parameters of other nodes."""

import pytest
from rcl_interfaces.msg import ParameterEvent
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_event_handler import ParameterEventHandler
from rclpy.serialization import serialize_message

from daidalos.interfaces.codec import CdrError
from ros.rclpy.waiting import executor_of, run_ready


def event_of(node: str, **values: object) -> ParameterEvent:
    parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
    return ParameterEvent(node=node, changed_parameters=parameters)


def test_an_event_can_be_searched() -> None:
    event = event_of("/robot", speed=3, name="r2")
    found = ParameterEventHandler.get_parameter_from_event(event, "speed", "/robot")
    assert found is not None
    assert found.value.integer_value == 3
    assert ParameterEventHandler.get_parameter_from_event(event, "speed", "/other") is None
    assert ParameterEventHandler.get_parameter_from_event(event, "weight", "/robot") is None
    assert [one.name for one in ParameterEventHandler.get_parameters_from_event(event)] == ["speed", "name"]


def test_callbacks_are_called_the_last_added_first(graph: Context) -> None:
    watcher, robot = Node("watcher", namespace="/here"), Node("robot", namespace="/here")
    robot.declare_parameter("speed", 1)
    handler = ParameterEventHandler(watcher)
    executor = executor_of(watcher, robot)
    calls: list[object] = []
    handles = [
        handler.add_parameter_callback("speed", "robot", lambda one: calls.append(("first", one.value.integer_value))),
        handler.add_parameter_callback("speed", "/here/robot", lambda one: calls.append("second")),
        handler.add_parameter_callback("speed", "/robot", lambda one: calls.append("another node's")),
    ]
    every = handler.add_parameter_event_callback(lambda event: calls.append(event.node))
    robot.set_parameters([Parameter("speed", value=2)])
    run_ready(executor)
    assert calls == ["second", ("first", 2), "/here/robot"]
    for handle in handles:
        handler.remove_parameter_callback(handle)
        with pytest.raises(RuntimeError):
            handler.remove_parameter_callback(handle)
    handler.remove_parameter_event_callback(every)
    with pytest.raises(RuntimeError):
        handler.remove_parameter_event_callback(every)
    calls.clear()
    robot.set_parameters([Parameter("speed", value=3)])
    run_ready(executor)
    assert calls == []
    handler.destroy()
    assert watcher.count_subscribers("/parameter_events") == 0


def test_only_some_nodes_may_be_of_interest(graph: Context) -> None:
    watcher, *robots = (Node(name) for name in ("watcher", "one", "two", "three"))
    for robot in robots:
        robot.declare_parameter("speed", 1)
    handler, executor = ParameterEventHandler(watcher), executor_of(watcher)
    received: list[str] = []
    handler.add_parameter_event_callback(lambda event: received.append(event.node))

    def change() -> list[str]:
        received.clear()
        for robot in robots:
            robot.set_parameters([Parameter("speed", value=2)])
        run_ready(executor)
        return received

    assert handler.configure_nodes_filter(["one", "/two"])
    assert change() == ["/one", "/two"]
    assert handler.configure_nodes_filter()
    assert change() == ["/one", "/two", "/three"]


def test_an_event_made_by_hand_may_hold_parameters() -> None:
    speed, name = Parameter("speed", value=3), Parameter("name", value="r2")
    event = ParameterEvent(node="/robot", new_parameters=[speed], changed_parameters=[name])
    assert set(ParameterEventHandler.get_parameters_from_event(event)) == {speed, name}
    with pytest.raises(CdrError, match=r"'new_parameters' field holds a 'rclpy\.parameter\.Parameter'"):
        serialize_message(event)
    with pytest.raises(AssertionError, match="sub message of type 'Parameter'"):
        ParameterEvent(new_parameters=[3])
