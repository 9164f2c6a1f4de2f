"""Structure and state of containers on topics, and commands that set their initial states."""

from __future__ import annotations

import io
import pickle
import threading
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import smach
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from smach_msgs.msg import SmachContainerInitialStatusCmd, SmachContainerStatus, SmachContainerStructure
from std_msgs.msg import Header

STATUS_TOPIC = "/smach/container_status"
INIT_TOPIC = "/smach/container_init"
STRUCTURE_TOPIC = "/smach/container_structure"

_PERIOD_S = 0.25


class _SpinningNode(Node):
    """Node that is spun in a thread of its own."""

    def __init__(self, name: str, **keywords: Any) -> None:
        super().__init__(name, **keywords)
        self._spinner = SingleThreadedExecutor(context=self.context)
        self._spinner.add_node(self)

        def spin() -> None:
            with suppress(ExternalShutdownException):
                self._spinner.spin()

        self._thread = threading.Thread(target=spin, daemon=True)
        self._thread.start()

    def destroy_node(self) -> None:
        """End the thread and the node."""
        self._spinner.shutdown()
        self._thread.join()
        super().destroy_node()


class IntrospectionClient(_SpinningNode):
    """Node that asks introspection servers.

    Parameters
    ----------
    node_name
        Name of the node.
    keywords
        For `rclpy.node.Node`.
    """

    def __init__(self, node_name: str = "introspection_client", **keywords: Any) -> None:
        super().__init__(node_name, **keywords)

    def get_servers(self) -> list[str]:
        """Return the names of the introspection servers."""
        return [
            topic.removesuffix(STATUS_TOPIC)
            for topic, types in self.get_topic_names_and_types()
            if "smach_msgs/msg/SmachContainerStatus" in types
        ]

    def set_initial_state(
        self,
        server: str,
        path: str,
        initial_states: Sequence[str],
        initial_userdata: smach.UserData | None = None,
        timeout: Duration | None = None,
    ) -> bool | None:
        """Set the states that a container begins with, and userdata.

        Parameters
        ----------
        server
            Name of the introspection server.
        path
            Path of the container.
        initial_states
            Labels of the states.
        initial_userdata
            Userdata that the container gets.
        timeout
            How long to wait for the confirmation; None: not at all.

        Returns
        -------
        bool
            Whether it was confirmed; None without `timeout`.
        """
        userdata = initial_userdata or smach.UserData()
        command = SmachContainerInitialStatusCmd(
            path=path, initial_states=list(initial_states), local_data=_packed(userdata)
        )
        confirmed = threading.Event()

        def check(status: SmachContainerStatus) -> None:
            if status.path == path and set(initial_states) <= set(status.initial_states):
                confirmed.set()

        subscription = self.create_subscription(SmachContainerStatus, f"{server}{STATUS_TOPIC}", check, 10)
        publisher = self.create_publisher(SmachContainerInitialStatusCmd, f"{server}{INIT_TOPIC}", 1)
        try:
            publisher.publish(command)
            if timeout is None:
                return None
            begin = self.get_clock().now()
            while not confirmed.wait(_PERIOD_S):
                if self.get_clock().now() - begin > timeout:
                    return False
                publisher.publish(command)
            return True
        finally:
            self.destroy_subscription(subscription)
            if timeout is not None:
                self.destroy_publisher(publisher)


class ContainerProxy:
    """Publisher of the structure and the state of one container.

    Parameters
    ----------
    node
        The node of the server.
    server_name
        Name of the server, with which its topics begin.
    container
        The container.
    path
        Its path.
    update_rate
        Period of repetition [s].
    """

    def __init__(self, node: Node, server_name: str, container: Any, path: str, update_rate: float = 2.0) -> None:
        self._node = node
        self._container = container
        self._path = path
        self._lock = threading.Lock()
        self._structure = node.create_publisher(SmachContainerStructure, f"{server_name}{STRUCTURE_TOPIC}", 1)
        self._status = node.create_publisher(SmachContainerStatus, f"{server_name}{STATUS_TOPIC}", 1)
        self._init = node.create_subscription(
            SmachContainerInitialStatusCmd, f"{server_name}{INIT_TOPIC}", self._set_initial_state, 1
        )
        self._timer = node.create_timer(update_rate, self._repeat)
        container.register_start_cb(self._notice)
        container.register_transition_cb(self._notice)
        container.register_termination_cb(self._notice)

    def stop(self) -> None:
        """Stop to publish."""
        self._node.destroy_timer(self._timer)
        self._node.destroy_subscription(self._init)
        self._node.destroy_publisher(self._structure)
        self._node.destroy_publisher(self._status)

    def _repeat(self) -> None:
        self.publish_status("HEARTBEAT")
        self.publish_structure()

    def _notice(self, *arguments: Any) -> None:
        self.publish_status(str(arguments[1:]))

    def publish_structure(self) -> None:
        """Publish the structure of the container."""
        edges = self._container.get_internal_edges()
        self._structure.publish(
            SmachContainerStructure(
                header=self._header(),
                path=self._path,
                children=list(self._container.get_children()),
                internal_outcomes=[str(outcome) for outcome, _, _ in edges],
                outcomes_from=[str(label) for _, label, _ in edges],
                outcomes_to=[str(target) for _, _, target in edges],
                container_outcomes=list(self._container.get_registered_outcomes()),
            )
        )

    def publish_status(self, info: str) -> None:
        """Publish the state of the container."""
        with self._lock:
            self._status.publish(
                SmachContainerStatus(
                    header=self._header(),
                    path=self._path,
                    initial_states=self._container.get_initial_states(),
                    active_states=self._container.get_active_states(),
                    local_data=_packed(self._container.userdata),
                    info=info,
                )
            )

    def _header(self) -> Header:
        return Header(stamp=self._node.get_clock().now().to_msg())

    def _set_initial_state(self, command: SmachContainerInitialStatusCmd) -> None:
        if command.path != self._path:
            return
        unknown = [label for label in command.initial_states if label not in self._container.get_children()]
        if unknown:
            self._node.get_logger().error(f"The container '{self._path}' has no states {unknown} to begin with")
            return
        userdata = smach.UserData()
        try:
            for key, value in _unpacked(bytes(command.local_data)).items():
                userdata[key] = value
        except (pickle.UnpicklingError, EOFError, AttributeError, ValueError) as error:
            self._node.get_logger().error(f"The userdata for '{self._path}' cannot be read: {error}")
            return
        self._container.set_initial_state(list(command.initial_states), userdata)
        self.publish_status("REMOTE_INIT")


class IntrospectionServer(_SpinningNode):
    """Node that publishes the structure and the state of a container and those inside of it.

    Parameters
    ----------
    server_name
        Name of the node, and beginning of its topics.
    state
        The container.
    path
        Its path, such as ``/``.
    """

    def __init__(self, server_name: str, state: Any, path: str) -> None:
        super().__init__(server_name.strip("/").replace("/", "_"))
        self._server_name = server_name
        self._state = state
        self._path = path
        self._proxies: list[ContainerProxy] = []

    def start(self) -> None:
        """Start to publish."""
        self.construct(self._server_name, self._state, self._path)

    def stop(self) -> None:
        """Stop to publish."""
        self.clear()

    def construct(self, server_name: str, state: Any, path: str) -> None:
        """Publish a container and those inside of it."""
        proxy = ContainerProxy(self, server_name, state, path)
        self._proxies.append(proxy)
        proxy.publish_structure()
        proxy.publish_status("Initial state")
        for label, child in state.get_children().items():
            if isinstance(child, smach.Container):
                self.construct(server_name, child, f"{path.rstrip('/')}/{label}")

    def clear(self) -> None:
        """Stop to publish and forget the containers."""
        for proxy in self._proxies:
            proxy.stop()
        self._proxies = []


def _packed(userdata: smach.UserData) -> bytes:
    """Return the plain values among userdata as a pickle; other values are left out."""
    plain = {key: userdata[key] for key in userdata.keys()}  # noqa: SIM118  # not a mapping
    return pickle.dumps({key: value for key, value in plain.items() if _is_plain(value)}, 2)


def _is_plain(value: Any) -> bool:
    if isinstance(value, list | tuple | set):
        return all(map(_is_plain, value))
    if isinstance(value, dict):
        return all(map(_is_plain, value)) and all(map(_is_plain, value.values()))
    return value is None or isinstance(value, bool | int | float | str | bytes)


class _PlainUnpickler(pickle.Unpickler):
    """Reader of pickles with plain values; others could run any code."""

    def find_class(self, module: str, name: str) -> Any:
        """Raise UnpicklingError but for sets."""
        if (module, name) in (("builtins", "set"), ("__builtin__", "set"), ("_codecs", "encode")):
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"'{module}.{name}' is not a plain value")


def _unpacked(data: bytes) -> dict[str, Any]:
    values = _PlainUnpickler(io.BytesIO(data)).load() if data else {}
    if not isinstance(values, dict):
        raise ValueError("expected a dictionary")
    return values
