"""`add_two_ints_client`: asks what two and three are."""

import sys

from daidalos.nodes.hello_world import request_sum
from daidalos.nodes.runner import run_program


def main() -> int:
    """Ask, and log the answer."""
    return run_program(
        lambda: request_sum(
            "add_two_ints_client", 2, 3, lambda node, total: node.get_logger().info(f"Result of add_two_ints: {total}")
        )
    )


if __name__ == "__main__":
    sys.exit(main())
