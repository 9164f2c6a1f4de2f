"""`ros2 action send_goal`."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from typing import TYPE_CHECKING, Any

from ros2cli.node.direct import add_arguments as add_direct_arguments
from ros2cli.node.direct import direct_node

from daidalos.cli.ros2.completion import complete_actions, complete_types, complete_values
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.graph import actions, check_type, types_of
from daidalos.cli.ros2.interfaces import action_class, fill, parse_values
from daidalos.cli.ros2.topics import spin
from daidalos.common.suggestions import near_or_all
from daidalos.transport.graph import EndpointKind

if TYPE_CHECKING:
    from rclpy.action import ActionClient
    from rclpy.action.client import ClientGoalHandle
    from rclpy.node import Node
    from ros2cli.graph import NamesAndTypes

_STATUS_NAMES = ("UNKNOWN", "ACCEPTED", "EXECUTING", "CANCELING", "SUCCEEDED", "CANCELED", "ABORTED")
"""Names of the states by their number in `action_msgs/msg/GoalStatus`."""
_CANCEL_TIMEOUT_S = 3.0


class SendGoalVerb(Verb):
    """Send an action goal."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        add_direct_arguments(parser)
        complete_actions(parser.add_argument("action_name", help="Name of the ROS action (e.g. '/fibonacci')"))
        complete_types(
            parser.add_argument(
                "action_type", help="Type of the ROS action (e.g. 'example_interfaces/action/Fibonacci')"
            ),
            "action",
            "action_name",
        )
        source = parser.add_mutually_exclusive_group()
        complete_values(
            source.add_argument(
                "goal", nargs="?", default="{}", help="Goal request values in YAML format (e.g. '{order: 10}')"
            ),
            "action_type",
        )
        source.add_argument("--stdin", action="store_true", help="Read values from standard input")
        parser.add_argument("-f", "--feedback", action="store_true", help="Echo feedback messages for the goal")

    def main(self, *, args: Namespace) -> Status:
        """Send the goal and wait for its result; Ctrl-C cancels it."""
        action_type = action_class(args.action_type)
        goal = action_type.Goal()
        values = parse_values(sys.stdin.read() if args.stdin else args.goal)
        stampers = fill(goal, values, "Failed to populate message fields: {!r}".format)
        with direct_node(args) as node:
            from rclpy.action import ActionClient

            for stamp in stampers:
                stamp(node.get_clock().now().to_msg())
            client = ActionClient(node, action_type, args.action_name)
            try:
                _wait(node, client, args.action_name, action_type._TYPE_NAME)
                _send(node, client, goal, args.feedback)
            finally:
                client.destroy()
        return 0


def _wait(node: Node, client: ActionClient, name: str, wanted: str) -> None:
    """Wait for the action's server, and print what there is instead; CliError if the action has another type."""
    graph, full_name = node.handle.graph, node.resolve_topic_name(name)

    def served() -> NamesAndTypes:
        return actions(graph.endpoints(EndpointKind.PUBLISHER))

    print("Waiting for an action server to become available...", flush=True)
    if not client.server_is_ready():
        check_type(served(), full_name, wanted)
        if not types_of(served(), full_name):
            sys.stderr.write(near_or_all(full_name, [other for other, _ in served()], "actions"))
            sys.stderr.flush()
            graph.wait_for(lambda: bool(types_of(served(), full_name)))
            check_type(served(), full_name, wanted)
    client.wait_for_server()


def _send(node: Node, client: ActionClient, goal: Any, show_feedback: bool) -> None:
    def on_feedback(message: Any) -> None:
        print(f"Feedback:\n    {_yaml(message.feedback)}")

    print(f"Sending goal:\n     {_yaml(goal)}")
    sent = client.send_goal_async(goal, on_feedback if show_feedback else None)
    spin(node, sent)
    handle = sent.result()
    if handle is None:
        raise CliError("The goal was sent, but its server answered nothing that can be understood")
    if not handle.accepted:
        print("Goal was rejected.")
        return
    print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
    try:
        finished = handle.get_result_async()
        spin(node, finished)
    except KeyboardInterrupt:
        _cancel(node, handle)
        raise
    result = finished.result()
    print(f"Result:\n    {_yaml(result.result)}")
    print(f"Goal finished with status: {_STATUS_NAMES[result.status]}")


def _cancel(node: Node, handle: ClientGoalHandle) -> None:
    """Request cancellation of the goal, and wait briefly for the response."""
    print("Canceling goal...")
    response = handle.cancel_goal_async()
    spin(node, response, _CANCEL_TIMEOUT_S)
    canceled = response.done() and any(info.goal_id == handle.goal_id for info in response.result().goals_canceling)
    print("Goal canceled." if canceled else "Failed to cancel goal")


def _yaml(message: Any) -> str:
    from rosidl_runtime_py import message_to_yaml

    text: str = message_to_yaml(message)
    return text
