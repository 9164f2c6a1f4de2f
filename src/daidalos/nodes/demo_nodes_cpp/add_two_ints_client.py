"""`add_two_ints_client`: requests the sum of 2 and 3."""

from daidalos.nodes.hello_world import request_sum
from daidalos.nodes.runner import run_program


def main() -> int:
    """Call the service and log the response."""
    return run_program(
        lambda: request_sum(
            "add_two_ints_client", 2, 3, lambda node, total: node.get_logger().info(f"Result of add_two_ints: {total}")
        )
    )
