"""What the leaves of a behaviour tree ask of the robot, done by actions and services of the graph."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from rclpy.action import ActionClient
from rclpy.node import Node

from daidalos.navigation.trees.services import Outcome, Task
from daidalos.nodes.action_results import error_name
from daidalos.samples.fields import duration_message

_SUCCEEDED = 4


@dataclass(frozen=True)
class _Action:
    """An action behind a leaf: its server's name, how a goal is made and what the result gives."""

    server: str
    goal: Callable[[Any, Mapping[str, Any]], Any]
    outputs: Callable[[Any], dict[str, Any]] = lambda result: {}


def _plan(kind: Any, ports: Mapping[str, Any]) -> Any:
    goal = kind.Goal(goal=ports["goal"], planner_id=ports.get("planner_id", ""))
    if ports.get("start") is not None:
        goal.start, goal.use_start = ports["start"], True
    return goal


def _follow(kind: Any, ports: Mapping[str, Any]) -> Any:
    names = {name: ports.get(name, "") for name in ("controller_id", "goal_checker_id", "progress_checker_id")}
    return kind.Goal(path=ports["path"], **names)


def _spin(kind: Any, ports: Mapping[str, Any]) -> Any:
    return kind.Goal(target_yaw=ports["spin_dist"], time_allowance=duration_message(ports["time_allowance"]))


def _drive(distance: str, speed: str) -> Callable[[Any, Mapping[str, Any]], Any]:
    def make(kind: Any, ports: Mapping[str, Any]) -> Any:
        goal = kind.Goal(speed=ports[speed], time_allowance=duration_message(ports["time_allowance"]))
        goal.target.x = ports[distance]
        return goal

    return make


def _wait(kind: Any, ports: Mapping[str, Any]) -> Any:
    return kind.Goal(time=duration_message(ports["wait_duration"]))


_ACTIONS = {
    "ComputePathToPose": _Action("compute_path_to_pose", _plan, lambda result: {"path": result.path}),
    "FollowPath": _Action("follow_path", _follow),
    "Spin": _Action("spin", _spin),
    "BackUp": _Action("backup", _drive("backup_dist", "backup_speed")),
    "DriveOnHeading": _Action("drive_on_heading", _drive("dist_to_travel", "speed")),
    "Wait": _Action("wait", _wait),
}
_SERVICES = ("ClearEntireCostmap", "ClearCostmapAroundRobot", "ClearCostmapExceptRegion")


class GraphServices:
    """Starts the tasks of a tree through a node; see `daidalos.navigation.trees.services.Services`."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._actions: dict[str, ActionClient] = {}
        self._clients: dict[str, Any] = {}

    def now(self) -> float:
        """Time of the node's clock [s]."""
        return self._node.get_clock().now().nanoseconds * 1e-9

    def start(self, action: str, goal: Mapping[str, Any]) -> Task:
        """Start what a leaf asks for."""
        if action in _SERVICES:
            return self._call(action, goal)
        kind = _ACTIONS.get(action)
        if kind is None:
            return _Failed(f"the leaf {action} is not known to this navigator")
        client = self._client_of(action, goal.get("server_name") or kind.server)
        return _ActionTask(client, kind, goal)

    def _client_of(self, action: str, server: str) -> ActionClient:
        if server not in self._actions:
            import nav2_msgs.action

            self._actions[server] = ActionClient(self._node, getattr(nav2_msgs.action, action), server)
        return self._actions[server]

    def _call(self, service: str, ports: Mapping[str, Any]) -> Task:
        import nav2_msgs.srv

        kind = getattr(nav2_msgs.srv, service)
        name = ports["service_name"]
        if name not in self._clients:
            self._clients[name] = self._node.create_client(kind, name)
        client = self._clients[name]
        if not client.service_is_ready():
            return _Failed(f"the service {name} is not there")
        request = kind.Request()
        if "reset_distance" in ports:
            request.reset_distance = ports["reset_distance"]
        return _ServiceTask(client.call_async(request))


class _Failed:
    """A task that could not be started."""

    def __init__(self, reason: str) -> None:
        self._reason = reason

    def poll(self) -> Outcome:
        """Return the failure."""
        return Outcome(False, error_code="UNKNOWN", error_msg=self._reason)

    def update(self, goal: Mapping[str, Any]) -> None:
        """Do nothing."""

    def halt(self) -> None:
        """Do nothing."""


class _ServiceTask:
    """A call of a service."""

    def __init__(self, future: Any) -> None:
        self._future = future

    def poll(self) -> Outcome | None:
        """Return success once the answer has come."""
        return Outcome(True) if self._future.done() else None

    def update(self, goal: Mapping[str, Any]) -> None:
        """Do nothing: a call cannot be changed."""

    def halt(self) -> None:
        """Do not wait for the answer."""
        self._future.cancel()


class _ActionTask:
    """A goal of an action; another goal takes its place when the leaf's inputs change."""

    def __init__(self, client: ActionClient, kind: _Action, ports: Mapping[str, Any]) -> None:
        self._client = client
        self._kind = kind
        self._handle: Any = None
        self._result: Any = None
        self._failure = ""
        self._generation = 0
        self._send(ports)

    def _send(self, ports: Mapping[str, Any]) -> None:
        self._generation += 1
        if not self._client.server_is_ready():
            self._failure = f"the action {self._kind.server} is not served"
            return
        generation = self._generation
        goal = self._kind.goal(self._client.action_type, ports)
        future = self._client.send_goal_async(goal)
        future.add_done_callback(lambda sent: self._on_sent(sent.result(), generation))

    def _on_sent(self, handle: Any, generation: int) -> None:
        if generation != self._generation:
            handle.cancel_goal_async()  # halted, or replaced, before the server answered
            return
        if not handle.accepted:
            self._failure = f"the goal was rejected by {self._kind.server}"
            return
        self._handle = handle
        handle.get_result_async().add_done_callback(lambda answer: self._on_result(answer.result(), generation))

    def _on_result(self, answer: Any, generation: int) -> None:
        if generation == self._generation:
            self._result = answer

    def poll(self) -> Outcome | None:
        """Return how the goal ended, None while it goes on."""
        if self._failure:
            return Outcome(False, error_code="UNKNOWN", error_msg=self._failure)
        if self._result is None:
            return None
        result = self._result.result
        if self._result.status == _SUCCEEDED:
            return Outcome(True, self._kind.outputs(result))
        code = error_name(result) if hasattr(result, "error_code") else "UNKNOWN"
        return Outcome(False, error_code=code, error_msg=getattr(result, "error_msg", ""))

    def update(self, goal: Mapping[str, Any]) -> None:
        """Send another goal, which the server takes up where it is."""
        self._handle = None
        self._send(goal)

    def halt(self) -> None:
        """Cancel the goal."""
        self._generation += 1
        if self._handle is not None and self._result is None:
            self._handle.cancel_goal_async()
