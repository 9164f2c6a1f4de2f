"""Actions: goals, feedback, results, cancellation, and results that are kept for a while."""

import threading
import time
from collections.abc import Callable
from typing import Any

import pytest
from action_msgs.msg import GoalStatus
from action_msgs.srv import CancelGoal
from rclpy.action import (
    ActionClient,
    ActionServer,
    CancelResponse,
    GoalResponse,
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock_type import ClockType
from rclpy.context import Context
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.impl.errors import InvalidHandle, RCLError
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.time import Time
from rclpy.waitable import NumberOfEntities
from test_msgs.action import Fibonacci

from ros.rclpy.waiting import LONG, executor_of, run_ready, spin_until

FibonacciSequence = [1, 1, 2, 3]


def succeed(goal: Any) -> Fibonacci.Result:
    goal.publish_feedback(Fibonacci.Feedback(sequence=FibonacciSequence[:2]))
    goal.succeed()
    return Fibonacci.Result(sequence=FibonacciSequence)


class Pair:
    """A server and a client of one action."""

    def __init__(self, node: Node, execute: Callable[[Any], Any] | None = succeed, **options: Any) -> None:
        self.node, self.executor = node, executor_of(node)
        self.server = ActionServer(node, Fibonacci, "fibonacci", execute, **options)
        self.client = ActionClient(node, Fibonacci, "fibonacci")
        self.feedback: list[list[int]] = []

    def send(self) -> Any:
        future = self.client.send_goal_async(
            Fibonacci.Goal(order=3), feedback_callback=lambda one: self.feedback.append(list(one.feedback.sequence))
        )
        return self.wait(future)

    def wait(self, future: Any) -> Any:
        self.executor.spin_until_future_complete(future, LONG)
        return future.result()


def test_a_goal_leads_to_feedback_and_a_result(node: Node) -> None:
    pair = Pair(node)
    assert pair.client.wait_for_server(0)
    goal = pair.send()
    assert goal.accepted
    answer = pair.wait(goal.get_result_async())
    assert (answer.status, list(answer.result.sequence)) == (GoalStatus.STATUS_SUCCEEDED, FibonacciSequence)
    assert pair.feedback == [FibonacciSequence[:2]]
    assert goal.status == GoalStatus.STATUS_SUCCEEDED


def test_feedback_comes_before_the_answer_that_it_preceded(node: Node) -> None:
    pair = Pair(node)
    request = Fibonacci.Impl.SendGoalService.Request()
    received: list[Any] = []
    node.create_subscription(Fibonacci.Impl.FeedbackMessage, "fibonacci/_action/feedback", received.append, 10)
    client = node.create_client(Fibonacci.Impl.SendGoalService, "fibonacci/_action/send_goal")
    assert pair.wait(client.call_async(request)).accepted
    assert len(received) == 1


@pytest.mark.parametrize("answer", [GoalResponse.REJECT, "no answer", ZeroDivisionError()])
def test_a_goal_may_be_refused(node: Node, answer: Any) -> None:
    def decide(goal: Any) -> Any:
        if isinstance(answer, Exception):
            raise answer
        return answer

    pair = Pair(node, goal_callback=decide)
    assert not pair.send().accepted
    assert not pair.server._goal_handles


def fail(goal: Any) -> Any:
    raise ZeroDivisionError("of an execute callback")


@pytest.mark.parametrize(
    ("execute", "status", "sequence"),
    [
        (lambda goal: goal.abort() or Fibonacci.Result(sequence=[1]), GoalStatus.STATUS_ABORTED, [1]),
        (lambda goal: Fibonacci.Result(sequence=[1]), GoalStatus.STATUS_ABORTED, [1]),
        (fail, GoalStatus.STATUS_ABORTED, []),
        (lambda goal: goal.succeed() or "no result", GoalStatus.STATUS_SUCCEEDED, []),
        (lambda goal: goal.succeed(Fibonacci.Result(sequence=[5])), GoalStatus.STATUS_SUCCEEDED, [5]),
    ],
    ids=["abort", "no state", "exception", "no result", "given result"],
)
def test_a_goal_may_end_otherwise(node: Node, execute: Any, status: int, sequence: list[int]) -> None:
    pair = Pair(node, execute)
    answer = pair.wait(pair.send().get_result_async())
    assert (answer.status, list(answer.result.sequence)) == (status, sequence)


@pytest.mark.parametrize("accepted", [True, False])
def test_cancelling_is_a_wish(node: Node, accepted: bool) -> None:
    goals: list[Any] = []
    response = CancelResponse.ACCEPT if accepted else CancelResponse.REJECT

    def end(goal: Any) -> Fibonacci.Result:
        (goal.canceled if goal.is_cancel_requested else goal.succeed)()
        return Fibonacci.Result()

    pair = Pair(node, end, handle_accepted_callback=goals.append, cancel_callback=lambda goal: response)
    goal = pair.send()
    answer = pair.wait(goal.cancel_goal_async())
    assert [one.goal_id for one in answer.goals_canceling] == ([goal.goal_id] if accepted else [])
    assert goals[0].is_cancel_requested is accepted
    goals[0].execute()
    expected = GoalStatus.STATUS_CANCELED if accepted else GoalStatus.STATUS_SUCCEEDED
    assert pair.wait(goal.get_result_async()).status == expected
    with pytest.raises(RCLError):
        goals[0].succeed()


def test_a_goal_that_is_cancelled_again_is_not_cancelable(node: Node) -> None:
    goals: list[Any] = []
    pair = Pair(node, None, handle_accepted_callback=goals.append, cancel_callback=lambda goal: CancelResponse.ACCEPT)
    goal = pair.send()
    assert pair.wait(goal.cancel_goal_async()).goals_canceling
    again = pair.wait(goal.cancel_goal_async())
    assert (list(again.goals_canceling), again.return_code) == ([], CancelGoal.Response.ERROR_GOAL_TERMINATED)
    assert goals[0].is_cancel_requested


def test_a_goal_may_be_carried_out_elsewhere(node: Node) -> None:
    goals: list[Any] = []

    def take(goal: Any) -> None:
        goal.executing()
        goals.append(goal)

    pair = Pair(node, None, handle_accepted_callback=take)
    future = pair.send().get_result_async()
    run_ready(pair.executor)
    assert not future.done()
    goals[0].succeed(Fibonacci.Result(sequence=[7]))
    assert list(pair.wait(future).result.sequence) == [7]


def test_a_goal_executed_without_an_executor_waits_for_one(node: Node) -> None:
    goals: list[Any] = []
    pair = Pair(node, handle_accepted_callback=goals.append)
    goal = pair.send()
    pair.executor.remove_node(node)
    goals[0].execute()
    pair.executor.add_node(node)
    assert pair.wait(goal.get_result_async()).status == GoalStatus.STATUS_SUCCEEDED


def test_the_same_goal_is_accepted_once(node: Node) -> None:
    pair = Pair(node)
    first = pair.send()
    again = pair.wait(pair.client.send_goal_async(Fibonacci.Goal(), goal_uuid=first.goal_id))
    assert (first.accepted, again.accepted) == (True, False)


def test_results_are_kept_for_a_time_of_the_nodes_clock(graph: Context) -> None:
    node = Node("tested", parameter_overrides=[Parameter("use_sim_time", value=True)])
    clock = node.get_clock()

    def show(seconds: float) -> None:
        clock.set_ros_time_override(Time(seconds=seconds, clock_type=ClockType.ROS_TIME))
        run_ready(pair.executor)

    pair = Pair(node, result_timeout=10)
    show(1)
    goal = pair.send()
    run_ready(pair.executor)
    handle = next(iter(pair.server._goal_handles.values()))
    show(10.9)
    assert handle.status == GoalStatus.STATUS_SUCCEEDED
    show(11.1)
    assert handle.status == GoalStatus.STATUS_UNKNOWN
    assert not pair.server._goal_handles
    assert pair.wait(goal.get_result_async()).status == GoalStatus.STATUS_UNKNOWN


@pytest.mark.parametrize("executor_class", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_a_callback_may_wait_for_an_action_of_its_own_node(node: Node, executor_class: type) -> None:
    with executor_class() as executor:
        executor.add_node(node)
        ActionServer(node, Fibonacci, "fibonacci", succeed)
        client = ActionClient(node, Fibonacci, "fibonacci")
        results: list[Any] = []
        node.create_guard_condition(lambda: results.append(client.send_goal(Fibonacci.Goal()))).trigger()
        spin_until(executor, lambda: results)
        assert list(results[0].result.sequence) == FibonacciSequence
        executor.remove_node(node)


def test_many_goals_at_once(node: Node) -> None:
    together = threading.Barrier(3)

    def execute(goal: Any) -> Fibonacci.Result:
        together.wait(LONG)
        return succeed(goal)

    with MultiThreadedExecutor(4) as executor:
        executor.add_node(node)
        group = ReentrantCallbackGroup()
        ActionServer(node, Fibonacci, "fibonacci", execute, callback_group=group)
        client = ActionClient(node, Fibonacci, "fibonacci", callback_group=group)
        futures = [client.send_goal_async(Fibonacci.Goal()) for _ in range(3)]
        spin_until(executor, lambda: all(one.done() for one in futures))
        results = [one.result().get_result_async() for one in futures]
        spin_until(executor, lambda: all(one.done() for one in results))
        assert {one.result().status for one in results} == {GoalStatus.STATUS_SUCCEEDED}
        executor.remove_node(node)


def test_without_a_server(node: Node) -> None:
    client = ActionClient(node, Fibonacci, "nobody")
    begin = time.monotonic()
    assert not client.wait_for_server(0.02)
    assert time.monotonic() - begin >= 0.02
    future = client.send_goal_async(Fibonacci.Goal())
    run_ready(executor_of(node))
    assert not future.done()
    with pytest.raises(TypeError):
        client.send_goal_async("no goal")
    client.destroy()
    with pytest.raises(InvalidHandle):
        client.server_is_ready()


def test_actions_are_in_the_graph(node: Node) -> None:
    pair = Pair(node)
    expected = [("/fibonacci", ["test_msgs/action/Fibonacci"])]
    assert get_action_names_and_types(node) == node.get_action_names_and_types() == expected
    assert get_action_server_names_and_types_by_node(node, "tested", "/") == expected
    assert get_action_client_names_and_types_by_node(node, "tested", "/") == expected
    assert pair.server.get_num_entities() == NumberOfEntities(num_timers=1, num_services=3)
    assert pair.client.get_num_entities() == NumberOfEntities(num_subs=2, num_clients=3)
    pair.server.destroy()
    pair.client.destroy()
    assert node.get_action_names_and_types() == []
