"""Nodes that share one process and one executor."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rclpy.node import Node

from daidalos.nodes.runner import create, ignore_interrupts, run_program


def run_together(nodes: Sequence[Callable[[], Node]]) -> int:
    """Create nodes and spin them in one executor until the process is asked to end; return the exit status."""
    import rclpy
    from rclpy.executors import SingleThreadedExecutor

    def body() -> None:
        rclpy.init()
        executor = SingleThreadedExecutor()
        made = []
        try:
            for make in nodes:
                made.append(create(make))
                executor.add_node(made[-1])
            executor.spin()
        finally:
            ignore_interrupts()
            for node in made:
                node.destroy_node()

    return run_program(body)
