"""Client that requests the sum of 41 and 1."""

from daidalos.nodes.hello_world import request_sum
from daidalos.nodes.runner import run_program

_A, _B = 41, 1


def main() -> int:
    """Call the service and log the response."""
    return run_program(
        lambda: request_sum(
            "minimal_client",
            _A,
            _B,
            lambda node, total: node.get_logger().info(f"Result of add_two_ints: for {_A} + {_B} = {total}"),
        )
    )
