"""`async_param_client`: sets, reads, lists and deletes parameters of ``parameter_blackboard``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python

from daidalos.nodes.runner import run_program

_TARGET = "parameter_blackboard"
_VALUES: dict[str, Any] = {"int_parameter": 10, "bool_parameter": False, "string_parameter": "Hello World"}


def _exercise(node: Node) -> None:
    import rclpy
    from rclpy.parameter_client import AsyncParameterClient

    log = node.get_logger()
    client = AsyncParameterClient(node, _TARGET)

    def wait(answer: Any) -> Any:
        rclpy.spin_until_future_complete(node, answer)
        return answer.result()

    while not client.wait_for_services(1.0):
        log.info(f"{_TARGET} not available, waiting again...")
    log.info("Setting parameters:")
    wanted: Sequence[Any] = [Parameter(name, value=value) for name, value in _VALUES.items()]
    results = wait(client.set_parameters(list(wanted))).results
    for name, result in zip(_VALUES, results, strict=True):
        log.info(f"  {name}: successful: {result.successful}")
    log.info("Listing Parameters:")
    for name in wait(client.list_parameters(list(_VALUES), 10)).result.names:
        log.info(f"  - {name}")
    log.info("Getting parameters:")
    for name, value in zip(_VALUES, wait(client.get_parameters(list(_VALUES))).values, strict=True):
        log.info(f"  - {name}: {parameter_value_to_python(value)}")
    log.info("Deleting parameters:")
    for name, result in zip(_VALUES, wait(client.delete_parameters(list(_VALUES))).results, strict=True):
        log.info(f"  {name}: successful: {result.successful}")


def main() -> int:
    """Run the sequence once."""

    def body() -> None:
        import rclpy

        rclpy.init()
        node = rclpy.create_node("async_param_client")
        try:
            _exercise(node)
        finally:
            node.destroy_node()

    return run_program(body)
