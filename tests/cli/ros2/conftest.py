"""A domain of its own for every test that runs commands, and programs that run beside them."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from daidalos.transport.graph import Graph

from .commands import environment

Env = dict[str, str]


@pytest.fixture
def env(domain: int) -> Env:
    """An environment with a domain that no other test uses at the same time."""
    return environment(domain)


@pytest.fixture
def beside(env: Env) -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Start Python programs that are ended with the test: ``beside(path or source text, *arguments)``."""
    running: list[subprocess.Popen[str]] = []

    def start(program: str | Path, *arguments: str) -> subprocess.Popen[str]:
        command = [sys.executable, program] if isinstance(program, Path) else [sys.executable, "-c", program]
        process = subprocess.Popen([*command, *arguments], env=env, text=True, stdout=subprocess.PIPE)
        running.append(process)
        return process

    yield start
    for process in running:
        process.kill()
        process.communicate()


@contextmanager
def _graph(domain: int) -> Iterator[Graph]:
    import rclpy
    from rclpy.context import Context
    from rclpy.node import Node

    context = Context()
    rclpy.init(args=[], context=context, domain_id=domain)
    node = Node("_watching", context=context, start_parameter_services=False)
    try:
        yield node.handle.graph
    finally:
        node.destroy_node()
        context.destroy()


@pytest.fixture
def wait_for(env: Env) -> Iterator[Callable[[str], None]]:
    """Wait until a topic or service of a name is there."""
    with _graph(int(env["ROS_DOMAIN_ID"])) as graph:

        def wait(name: str) -> None:
            assert graph.wait_for(lambda: bool(graph.endpoints(name=name)), 60), f"{name} did not come"

        yield wait
