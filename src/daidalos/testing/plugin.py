"""Plugin of pytest: tests marked with ``scenario`` run in lock-step, each in a process of its own.

Nothing else is imported before a test with that mark runs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from pathlib import Path

    from daidalos.testing.graph import ActionClient, Service, Topic
    from daidalos.testing.network import Network
    from daidalos.testing.programs import Nodes, RunningNode
    from daidalos.testing.scenario import Scenario
    from daidalos.testing.signals import Signal
    from daidalos.testing.worlds import Robot, World

TIMEOUT_S = 60.0
"""Simulated time [s] that a scenario may take where its mark does not say it."""

_RUNNER = pytest.StashKey[Any]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare the options."""
    group = parser.getgroup("scenarios", "tests of robots in lock-step")
    group.addoption(
        "--scenario-seed", type=int, metavar="N", help="seed of all scenarios, in place of those of their marks"
    )
    group.addoption(
        "--scenario-results",
        metavar="FOLDER",
        default="scenario-results",
        help="where bags and pictures of failures are kept (default: scenario-results)",
    )
    group.addoption("--scenario-keep", action="store_true", help="keep the bags of scenarios that passed as well")


def pytest_configure(config: pytest.Config) -> None:
    """Declare the mark."""
    config.addinivalue_line(
        "markers",
        "scenario(timeout=60, seed=0, world=None, robot=None, record=True, pictures=False): run a test in lock-step, "
        "with a time-out in simulated seconds",
    )


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> bool | None:
    """Run a scenario in its process."""
    if item.get_closest_marker("scenario") is None:
        return None
    from daidalos.testing.present import present

    if present() is not None:
        return None
    from daidalos.testing.parent import ScenarioRunner

    if _RUNNER not in item.config.stash:
        item.config.stash[_RUNNER] = ScenarioRunner(item.config)
    item.config.stash[_RUNNER].run(item)
    return True


def pytest_unconfigure(config: pytest.Config) -> None:
    """End the process of the scenarios."""
    runner = config.stash.get(_RUNNER, None)
    if runner is not None:
        runner.close()


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collect scenarios that are written as YAML: ``*.scenario.yaml``, or any that is named."""
    name = file_path.name
    if not name.endswith((".yaml", ".yml")):
        return None
    if not name.endswith((".scenario.yaml", ".scenario.yml")) and not parent.session.isinitpath(file_path):
        return None
    from daidalos.testing.yaml_items import ScenarioFile

    collector: pytest.Collector = ScenarioFile.from_parent(parent, path=file_path)
    return collector


# Fixtures --------------------------------------------------------------------------------------------


@pytest.fixture
def scenario() -> Scenario:
    """Return the run that the test is part of: its clock, its parameters, what it waits for."""
    from daidalos.testing.present import present

    found = present()
    if found is None:
        pytest.fail("the fixtures of scenarios are for tests marked with @pytest.mark.scenario", pytrace=False)
    return found


@pytest.fixture
def clock(scenario: Scenario) -> Scenario:
    """Return the simulated time: ``clock.now`` and ``clock.sleep(seconds)``."""
    return scenario


@pytest.fixture
def nodes(scenario: Scenario) -> Nodes:
    """Return the programs under test: ``nodes.run(package, executable)``, ``nodes["name"].kill()``."""
    from daidalos.testing.programs import Nodes

    return Nodes(scenario)


@pytest.fixture
def launch(nodes: Nodes) -> Any:
    """Return a function that launches a file: ``launch(package, file, argument=value)``, or ``launch(path)``."""

    def start(*words: str | Path, **arguments: object) -> RunningNode:
        return nodes.launch(*words, **arguments)

    return start


@pytest.fixture
def world(scenario: Scenario, nodes: Nodes, request: pytest.FixtureRequest) -> World:
    """Return the simulated world: that of the mark, or what the test loads or launches."""
    from daidalos.testing.worlds import World

    made = World(scenario, nodes)
    wanted = _of_mark(request, "world")
    if wanted is not None:
        made.load(wanted)
    return made


@pytest.fixture
def robot(world: World, request: pytest.FixtureRequest) -> Robot:
    """Return the robot of the mark, in the middle of its world; a waffle where it names none."""
    if _of_mark(request, "world") is None:
        world.load()
    return world.spawn(_of_mark(request, "robot") or "waffle")


@pytest.fixture
def topic(scenario: Scenario) -> Any:
    """Return a function that returns a topic: ``topic("/scan").eventually(...)``."""
    topics: dict[str, Topic] = {}

    def get(name: str) -> Topic:
        from daidalos.testing.graph import Topic

        if name not in topics:
            topics[name] = Topic(scenario, name)
        return topics[name]

    return get


@pytest.fixture
def transform(scenario: Scenario) -> Any:
    """Return a function that returns a transform: ``transform("odom", "base_link").eventually(x=1.0, within=5.0)``."""
    from daidalos.testing.graph import Transforms

    transforms = Transforms(scenario)

    def get(parent: str, child: str) -> Signal:
        return transforms.signal(parent, child)

    return get


@pytest.fixture
def service(scenario: Scenario) -> Any:
    """Return a function that returns a service: ``service("/spawn").call(x=1.0, within=2.0)``."""

    def get(name: str, kind: Any = None) -> Service:
        from daidalos.testing.graph import Service

        return Service(scenario, name, kind)

    return get


@pytest.fixture
def action(scenario: Scenario) -> Any:
    """Return a function that returns an action: ``action("/fibonacci", Fibonacci).send(order=5, within=10.0)``."""

    def get(name: str, kind: Any) -> ActionClient:
        from daidalos.testing.graph import ActionClient

        return ActionClient(scenario, name, kind)

    return get


@pytest.fixture
def network(scenario: Scenario) -> Network:
    """Return the connections between the nodes: latency, loss and drop-outs on topics."""
    from daidalos.testing.network import Network

    return Network(scenario)


def _of_mark(request: pytest.FixtureRequest, name: str) -> Any:
    mark = request.node.get_closest_marker("scenario")
    return None if mark is None else mark.kwargs.get(name)
