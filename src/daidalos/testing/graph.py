"""Topics, transforms, services and actions of the graph under test."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from daidalos.common.documents import parse_yaml
from daidalos.common.pose3 import Pose
from daidalos.common.suggestions import hint
from daidalos.testing.scenario import Scenario, ScenarioFailure
from daidalos.testing.signals import FIRST_S, Signal, describe

if TYPE_CHECKING:
    from daidalos.transport.graph import EndpointInfo


@dataclass(frozen=True)
class PoseValue:
    """Position [m] and fixed-axis angles [rad] of a frame in another one."""

    x: float
    y: float
    z: float
    roll: float
    pitch: float
    yaw: float

    @classmethod
    def of(cls, pose: Pose) -> PoseValue:
        """Return the value of a pose."""
        return cls(*pose.position, *pose.rpy)

    def distance_to(self, x: float, y: float) -> float:
        """Return the horizontal distance [m] to a point."""
        return float(((self.x - x) ** 2 + (self.y - y) ** 2) ** 0.5)

    def __repr__(self) -> str:
        return f"x {self.x:.3f}, y {self.y:.3f}, z {self.z:.3f}, yaw {self.yaw:.3f}"


class Topic(Signal):
    """Messages of a topic, whose type and quality of service are those of its publishers.

    Parameters
    ----------
    scenario : Scenario
    name : str
    """

    def __init__(self, scenario: Scenario, name: str) -> None:
        from daidalos.transport.graph import EndpointKind

        self.topic = name if name.startswith("/") else f"/{name}"
        super().__init__(scenario, self.topic)
        self._subscription: Any = None
        scenario.node.handle.session.watch(self.topic, self._on_publisher, EndpointKind.PUBLISHER)

    def _on_publisher(self, added: bool, endpoint: EndpointInfo) -> None:
        """Subscribe as soon as there is a publisher, with the strictest profile that all publishers offer."""
        from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
        from rosidl_runtime_py.utilities import get_message

        if not added or self._subscription is not None:
            return
        qos = endpoint.qos
        profile = QoSProfile(
            depth=1000,
            reliability=ReliabilityPolicy.RELIABLE if qos.reliable else ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if qos.transient_local else DurabilityPolicy.VOLATILE,
        )
        kind = get_message(endpoint.type_name)
        self._subscription = self.scenario.node.create_subscription(kind, self.topic, self.push, profile)

    def explain(self) -> str:
        """Return whether the topic is there at all, with similar names."""
        names = [name for name, _ in self.scenario.node.get_topic_names_and_types()]
        if self._subscription is not None:
            return "; it has a publisher"
        return f"; nothing publishes '{self.topic}'{hint(self.topic, [name for name in names if name != self.topic])}"


class Transforms:
    """The transforms that are published."""

    def __init__(self, scenario: Scenario) -> None:
        from tf2_ros import Buffer

        self.buffer = Buffer()
        self._scenario = scenario
        self._signals: list[tuple[Signal, str, str]] = []
        Topic(scenario, "/tf").listen(lambda when, message: self._on_message(message, is_static=False))
        Topic(scenario, "/tf_static").listen(lambda when, message: self._on_message(message, is_static=True))

    def signal(self, parent: str, child: str) -> Signal:
        """Return the pose of a frame in another one, whenever it changes."""
        signal = _Transform(self._scenario, self.buffer, parent, child)
        self._signals.append((signal, parent, child))
        return signal

    def _on_message(self, message: Any, *, is_static: bool) -> None:
        from rclpy.time import Time

        for transform in message.transforms:
            add = self.buffer.set_transform_static if is_static else self.buffer.set_transform
            add(transform, "scenario")
        for signal, parent, child in self._signals:
            if self.buffer.can_transform(parent, child, Time()):
                signal.push(_pose_of(self.buffer.lookup_transform(parent, child, Time()).transform))


class _Transform(Signal):
    """Pose of a frame in another one."""

    def __init__(self, scenario: Scenario, buffer: Any, parent: str, child: str) -> None:
        super().__init__(scenario, f"the transform of '{child}' in '{parent}'")
        self._buffer = buffer
        self._frames = parent, child

    def explain(self) -> str:
        """Return which of the frames there is none of."""
        frames = parse_yaml(self._buffer.all_frames_as_yaml()) or {}
        names = sorted({*frames, *(frame["parent"] for frame in frames.values())})
        missing = [frame for frame in self._frames if frame not in names]
        return "".join(f"; there is no frame '{frame}'{hint(frame, names)}" for frame in missing)


def _pose_of(transform: Any) -> PoseValue:
    t, r = transform.translation, transform.rotation
    return PoseValue.of(Pose((t.x, t.y, t.z), (r.x, r.y, r.z, r.w)))


class Service:
    """Service of the graph.

    Parameters
    ----------
    scenario : Scenario
    name : str
    kind : class, optional
        Its type; the server's where None.
    """

    def __init__(self, scenario: Scenario, name: str, kind: Any = None) -> None:
        self.name = name if name.startswith("/") else f"/{name}"
        self._scenario = scenario
        self._kind = kind
        self._client: Any = None

    def available(self, within: float = FIRST_S) -> None:
        """Require that a server is there within some time [s].

        Raises
        ------
        ScenarioFailure
        """
        __tracebackhide__ = True
        if not self._scenario.wait_for_graph(self._has_server, within):
            names = [name for name, _ in self._scenario.node.get_service_names_and_types()]
            raise ScenarioFailure(f"there was no service '{self.name}' within {within:g} s{hint(self.name, names)}")

    def _has_server(self) -> bool:
        node = self._scenario.node
        return any(name == self.name for name, _ in node.get_service_names_and_types())

    def call(self, *, within: float = FIRST_S, **fields: Any) -> Any:
        """Call it with the fields of a request, wait for the response and return it.

        Raises
        ------
        ScenarioFailure
            When there is no server, or no response in time.
        """
        __tracebackhide__ = True
        self.available(within)
        return self.send(self._ensure_client().srv_type.Request(**fields), within=within)

    def send(self, request: Any, *, within: float = FIRST_S) -> Any:
        """Send a request, wait for the response and return it; see `call`."""
        __tracebackhide__ = True
        self.available(within)
        future = self._ensure_client().call_async(request)
        future.add_done_callback(lambda _: self._scenario.notify())
        if not self._scenario.wait(future.done, within):
            raise ScenarioFailure(f"the service '{self.name}' has not answered within {within:g} s")
        return future.result()

    def _ensure_client(self) -> Any:
        from rosidl_runtime_py.utilities import get_service

        if self._client is None:
            node = self._scenario.node
            types = dict(node.get_service_names_and_types())
            kind = self._kind or get_service(types[self.name][0])
            self._client = node.create_client(kind, self.name)
        return self._client


class ActionClient:
    """Action of the graph.

    Parameters
    ----------
    scenario : Scenario
    name : str
    kind : class
        Its type.
    """

    def __init__(self, scenario: Scenario, name: str, kind: Any) -> None:
        from rclpy.action import ActionClient as Client

        self.name = name if name.startswith("/") else f"/{name}"
        self._scenario = scenario
        self._kind = kind
        self._client = Client(scenario.node, kind, self.name)

    def send(self, *, within: float, on_feedback: Callable[[Any], None] | None = None, **fields: Any) -> Any:
        """Send a goal of some fields, and wait for its result; return the result of a goal that succeeded.

        Raises
        ------
        ScenarioFailure
            When there is no server, the goal is rejected, does not succeed or has not ended in time.
        """
        __tracebackhide__ = True
        return self.send_goal(self._kind.Goal(**fields), within=within, on_feedback=on_feedback)

    def start_goal(self, goal: Any, *, within: float, on_feedback: Callable[[Any], None] | None = None) -> Any:
        """Send a goal, wait until it is accepted, and return the future of its result.

        Raises
        ------
        ScenarioFailure
            When there is no server in time, or the goal is rejected.
        """
        __tracebackhide__ = True
        until = self._scenario.now + within
        if not self._scenario.wait_for_graph(self._client.server_is_ready, within):
            raise ScenarioFailure(f"there was no action '{self.name}' within {within:g} s")
        accepted = self._client.send_goal_async(goal, feedback_callback=on_feedback)
        accepted.add_done_callback(lambda _: self._scenario.notify())
        left = until - self._scenario.now
        if not self._scenario.wait(accepted.done, left) or not accepted.result().accepted:
            raise ScenarioFailure(f"the action '{self.name}' did not accept the goal")
        result = accepted.result().get_result_async()
        result.add_done_callback(lambda _: self._scenario.notify())
        return result

    def send_goal(self, goal: Any, *, within: float, on_feedback: Callable[[Any], None] | None = None) -> Any:
        """Send a goal, and wait for its result; see `send`."""
        __tracebackhide__ = True
        from action_msgs.msg import GoalStatus

        until = self._scenario.now + within
        result = self.start_goal(goal, within=within, on_feedback=on_feedback)
        if not self._scenario.wait(result.done, until - self._scenario.now):
            raise ScenarioFailure(f"the goal of '{self.name}' has not ended within {within:g} s")
        outcome = result.result()
        if outcome.status != GoalStatus.STATUS_SUCCEEDED:
            names = {
                getattr(GoalStatus, name): name.removeprefix("STATUS_").lower()
                for name in dir(GoalStatus)
                if name.startswith("STATUS_")
            }
            status = names.get(outcome.status, outcome.status)
            raise ScenarioFailure(f"the goal of '{self.name}' was {status}: {describe(outcome.result)}")
        return outcome.result
