"""States with topics, services and actions, state machines as action servers, and introspection."""

import pickle
import threading

import pytest
import rclpy
import smach
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient, ActionServer, CancelResponse
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from smach_msgs.msg import SmachContainerInitialStatusCmd
from smach_ros import (
    ActionServerWrapper,
    ConditionState,
    IntrospectionClient,
    IntrospectionServer,
    MonitorState,
    ServiceState,
    SimpleActionState,
)
from std_msgs.msg import Int32
from std_srvs.srv import SetBool
from test_msgs.action import Fibonacci

from ros.graph import spinning


def executed(state, node, **userdata):
    """Execute a state in a machine; return its outcome and the userdata."""
    machine = smach.StateMachine(state.get_registered_outcomes())
    for key, value in userdata.items():
        machine.userdata[key] = value
    with machine:
        smach.StateMachine.add("STATE", state)
    with spinning(node):
        return machine.execute(), machine.userdata


@pytest.fixture
def fibonacci(node):
    """A server that returns as many numbers as the order says; orders above 9 last until they are canceled."""

    def execute(goal):
        if goal.request.order > 9:
            while not goal.is_cancel_requested:
                rate.sleep()
            goal.canceled()
        else:
            goal.succeed()
        return Fibonacci.Result(sequence=list(range(goal.request.order)))

    other = rclpy.create_node("server")
    rate = other.create_rate(50)
    server = ActionServer(other, Fibonacci, "/count", execute, cancel_callback=lambda goal: CancelResponse.ACCEPT)
    executor = MultiThreadedExecutor(3)
    executor.add_node(other)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    yield
    executor.shutdown()
    thread.join()
    server.destroy()


def test_an_action_takes_the_goal_from_userdata_and_stores_the_result(node, fibonacci):
    state = SimpleActionState(node, "/count", Fibonacci, goal_slots=["order"], result_slots=["sequence"])
    outcome, userdata = executed(state, node, order=3)
    assert (outcome, list(userdata.sequence)) == ("succeeded", [0, 1, 2])


def test_callbacks_of_an_action(node, fibonacci):
    @smach.cb_interface(input_keys=["wanted"])
    def fill(ud, goal, plus):
        goal.order = ud.wanted + plus

    @smach.cb_interface(outcomes=["long"], output_keys=["got"])
    def store(ud, status, result):
        assert status == GoalStatus.STATUS_SUCCEEDED
        ud.got = len(result.sequence)
        return "long"

    state = SimpleActionState(node, "/count", Fibonacci, goal_cb=fill, goal_cb_args=[1], result_cb=store)
    outcome, userdata = executed(state, node, wanted=4)
    assert (outcome, userdata.got) == ("long", 5)


def test_an_action_that_lasts_too_long_is_canceled(node, fibonacci):
    goal = Fibonacci.Goal(order=10)
    state = SimpleActionState(node, "/count", Fibonacci, goal=goal, exec_timeout=Duration(seconds=0.1))
    assert executed(state, node)[0] == "preempted"


def test_an_action_without_a_server_is_aborted(node):
    state = SimpleActionState(node, "/nothing", Fibonacci, server_wait_timeout=Duration(seconds=0.1))
    assert executed(state, node)[0] == "aborted"
    with pytest.raises(smach.InvalidStateError, match="no fields \\['odrer'\\]"):
        SimpleActionState(node, "/nothing", Fibonacci, goal_slots=["odrer"])


def test_a_service_takes_the_request_from_userdata_and_stores_the_response(node):
    def serve(request, response):
        response.success, response.message = request.data, "so"
        return response

    node.create_service(SetBool, "/switch", serve)
    state = ServiceState(node, "/switch", SetBool, request_slots=["data"], response_slots=["success", "message"])
    outcome, userdata = executed(state, node, data=True)
    assert (outcome, userdata.success, userdata.message) == ("succeeded", True, "so")
    assert executed(ServiceState(node, "/switch", SetBool, request_slots=["data"]), node)[0] == "aborted"


def test_a_monitor_ends_at_the_first_bad_message(node):
    publisher = node.create_publisher(Int32, "/level", 10)
    numbers = iter(range(100))
    node.create_timer(0.01, lambda: publisher.publish(Int32(data=next(numbers))))
    assert executed(MonitorState(node, "/level", Int32, lambda ud, message: message.data < 5), node)[0] == "invalid"
    assert executed(MonitorState(node, "/level", Int32, lambda ud, message: True, max_checks=2), node)[0] == "valid"


def test_a_condition_is_checked_until_it_holds(node):
    answers = iter([False, False, True])
    assert executed(ConditionState(node, lambda ud: next(answers), poll_rate=100, max_checks=-1), node)[0] == "true"
    assert executed(ConditionState(node, lambda ud: False, poll_rate=100, max_checks=3), node)[0] == "false"


def test_a_machine_is_an_action_server(graph, node):
    def count(ud):
        ud.sequence = list(range(ud.order))
        return "done"

    keys = {"input_keys": ["order"], "output_keys": ["sequence"]}
    machine = smach.StateMachine(["done"], **keys)
    with machine:
        smach.StateMachine.add("COUNT", smach.CBState(count, outcomes=["done"], **keys))
    ActionServerWrapper(
        node, "/count", Fibonacci, machine, succeeded_outcomes=["done"], expand_goal_slots=True, pack_result_slots=True
    )
    other = rclpy.create_node("asking")
    client = ActionClient(other, Fibonacci, "/count")
    with spinning(node), spinning(other):
        assert client.wait_for_server(5.0)
        answer = client.send_goal(Fibonacci.Goal(order=4))
    assert (answer.status, list(answer.result.sequence)) == (GoalStatus.STATUS_SUCCEEDED, [0, 1, 2, 3])
    client.destroy()


def test_a_container_shows_itself_and_takes_its_initial_state(graph, node):
    machine = smach.StateMachine(["done"])
    with machine:
        smach.StateMachine.add("A", smach.CBState(lambda ud: "done", outcomes=["done"]), {"done": "B"})
        smach.StateMachine.add("B", smach.CBState(lambda ud: "done", outcomes=["done"]))
    server, client = IntrospectionServer("/seen", machine, "/ROOT"), IntrospectionClient()
    server.start()
    with spinning(node):
        assert client.get_servers() == ["/seen"]
        data = smach.UserData()
        data.speed = 0.5
        assert client.set_initial_state("/seen", "/ROOT", ["B"], data, timeout=Duration(seconds=10.0))
        assert (machine.get_initial_states(), machine.userdata.speed) == (["B"], 0.5)
        code = pickle.dumps({"x": threading.Thread})
        command = SmachContainerInitialStatusCmd(path="/ROOT", initial_states=["A"], local_data=code)
        server._proxies[0]._set_initial_state(command)
        assert machine.get_initial_states() == ["B"]
        assert machine.execute() == "done"
    server.destroy_node()
    client.destroy_node()
