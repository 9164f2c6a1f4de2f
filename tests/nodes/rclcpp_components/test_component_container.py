"""The container: loading nodes, telling of them, unloading them."""

from collections.abc import Iterator
from typing import Any

import pytest
import rclpy
from composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
from rclpy.executors import SingleThreadedExecutor
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.task import Future
from std_msgs.msg import String
from std_srvs.srv import Trigger

from daidalos.nodes import extensions
from daidalos.nodes.rclcpp_components.component_container import ComponentContainer


class Worker(Node):
    """A component: it answers, and says what it was given."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("worker", **kwargs)
        self.declare_parameter("speed", 1)
        if self.get_parameter("speed").value < 0:
            raise ValueError("speed must not be negative")
        self.create_service(Trigger, "~/work", self._work)
        self.create_publisher(String, "chatter", 10)

    def _work(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.message = str(self.get_parameter("speed").value)
        return response


class Containers:
    """A container, and a node that asks it."""

    def __init__(self) -> None:
        self.container, self.asker = ComponentContainer(), Node("asker")
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.container)
        self.executor.add_node(self.asker)

    def ask(self, kind: Any, name: str, **fields: Any) -> Any:
        client = self.asker.create_client(kind, name)
        future: Future = client.call_async(kind.Request(**fields))
        self.executor.spin_until_future_complete(future, 10)
        self.asker.destroy_client(client)
        return future.result()

    def load(self, **fields: Any) -> Any:
        fields = {"package_name": "workshop", "plugin_name": "workshop::Worker", **fields}
        return self.ask(LoadNode, "/ComponentManager/_container/load_node", **fields)

    def listed(self) -> dict[int, str]:
        answer = self.ask(ListNodes, "/ComponentManager/_container/list_nodes")
        return dict(zip(answer.unique_ids, answer.full_node_names, strict=True))

    def unload(self, number: int) -> Any:
        return self.ask(UnloadNode, "/ComponentManager/_container/unload_node", unique_id=number)


@pytest.fixture
def containers(monkeypatch: pytest.MonkeyPatch) -> Iterator[Containers]:
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_daidalos_inprocess")
    find = extensions.find_component

    def find_ours(package: str, plugin: str) -> Any:
        return Worker if (package, plugin) == ("workshop", "workshop::Worker") else find(package, plugin)

    monkeypatch.setattr("daidalos.nodes.rclcpp_components.component_container.find_component", find_ours)
    with rclpy.init(args=[]):
        made = Containers()
        yield made
        made.container.destroy_node()


def test_nodes_come_and_go(containers: Containers) -> None:
    assert containers.listed() == {}
    first, second = containers.load(), containers.load(node_name="other", node_namespace="/ns")
    assert (first.success, second.success) == (True, True)
    assert containers.listed() == {first.unique_id: "/worker", second.unique_id: "/ns/other"}
    assert containers.ask(Trigger, "/ns/other/work").message == "1"
    assert containers.unload(first.unique_id).success
    assert containers.listed() == {second.unique_id: "/ns/other"}
    assert "worker" not in containers.asker.get_node_names()
    again = containers.unload(first.unique_id)
    assert not again.success
    assert str(first.unique_id) in again.error_message
    assert containers.load().unique_id not in (first.unique_id, second.unique_id)


def test_a_node_gets_its_parameters_rules_and_level(containers: Containers) -> None:
    answer = containers.load(
        parameters=[Parameter("speed", value=7).to_parameter_msg()],
        remap_rules=["chatter:=talk"],
        log_level=int(LoggingSeverity.DEBUG),
    )
    assert containers.ask(Trigger, "/worker/work").message == "7"
    assert containers.asker.count_publishers("/talk") == 1
    node, _ = containers.container._loaded[answer.unique_id]
    assert node.get_logger().get_effective_level() == LoggingSeverity.DEBUG
    node.get_logger().set_level(LoggingSeverity.UNSET)


def test_what_cannot_be_loaded_is_explained(containers: Containers) -> None:
    missing = containers.load(plugin_name="workshop::Nothing")
    assert (missing.success, missing.unique_id) == (False, 0)
    assert "workshop::Nothing" in missing.error_message
    broken = containers.load(parameters=[Parameter("speed", value=-1).to_parameter_msg()])
    assert not broken.success
    assert "must not be negative" in broken.error_message
    assert containers.listed() == {}
