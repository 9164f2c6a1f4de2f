"""Steps of scenarios that are written as YAML."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from daidalos.common.errors import Location, UserError
from daidalos.testing.conditions import condition, read_field
from daidalos.testing.documents import Document, Step
from daidalos.testing.graph import ActionClient, Service, Topic, Transforms
from daidalos.testing.network import Network
from daidalos.testing.programs import Nodes
from daidalos.testing.scenario import Scenario, ScenarioFailure
from daidalos.testing.signals import Signal
from daidalos.testing.worlds import Robot, World

_SOURCE = ("topic", "field", "transform", "robot", "of", "ignore", "point")


class Performance:
    """Performance of a scenario that is written as YAML.

    Parameters
    ----------
    scenario : Scenario
    document : Document
    """

    def __init__(self, scenario: Scenario, document: Document) -> None:
        self._scenario = scenario
        self._document = document
        self._nodes = Nodes(scenario)
        self._world = World(scenario, self._nodes)
        self._network = Network(scenario)
        self._topics: dict[str, Topic] = {}
        self._ways: dict[str, list[float]] = {}

    @functools.cached_property
    def _transforms(self) -> Transforms:
        return Transforms(self._scenario)

    def run(self) -> None:
        """Run it.

        Raises
        ------
        ScenarioFailure
            What does not hold, with file and line.
        UserError
            What cannot be carried out, with file and line.
        """
        document = self._document
        if document.world is not None:
            self._world.load(self._path(document.world))
        for step in document.setting:
            self._do(step)
        for step in document.requirements:
            self._do(step)
        for step in document.steps:
            self._do(step)
        self._scenario.check()
        self._measure()

    def _do(self, step: Step) -> None:
        place = Location(str(self._document.path), step.line)
        try:
            getattr(self, f"_{step.kind}")(**dict(step.values))
        except ScenarioFailure as failure:
            raise ScenarioFailure(f"{place.prefix()}{failure}") from None
        except UserError as error:
            raise UserError(str(error), place) from None
        except (LookupError, ValueError, TypeError, AttributeError) as error:
            raise UserError(f"'{step.kind}': {error}", place) from None

    def _path(self, name: str) -> str:
        """Return a path that is relative to the scenario's file."""
        beside = self._document.path.parent / name
        return str(beside.resolve()) if beside.is_file() else name

    # What is there.

    def _launch(self, file: str, package: str = "", arguments: Mapping[str, Any] | None = None) -> None:
        words = [package, file] if package else [self._path(file)]
        self._nodes.launch(*words, **dict(arguments or {}))

    def _run(self, package: str, executable: str, arguments: list[Any] | None = None, **options: Any) -> None:
        self._nodes.run(package, executable, *map(str, arguments or ()), **options)

    def _spawn(self, model: str, **options: Any) -> None:
        self._follow(self._world.spawn(self._path(model), **options))

    def _box(self, name: str, x: float, y: float, size: list[float] | None = None, yaw: float = 0.0) -> None:
        edges = {} if size is None else {"size": _three(size, "size")}
        self._world.box(name, x=x, y=y, yaw=yaw, **edges)

    def _walk(self, name: str, path: list[list[float]], speed: float = 1.0, loop: bool = True) -> None:
        self._world.walk(name, [(float(x), float(y)) for x, y in path], speed=speed, loop=loop)

    def _crowd(
        self, count: int, speed: list[float] | None = None, avoid: list[str] | None = None, name: str = "person"
    ) -> None:
        if speed is not None and len(speed) != 2:
            raise UserError(f"'speed' should have 2 numbers, got {len(speed)}")
        slow, fast = (0.6, 1.4) if speed is None else (float(one) for one in speed)
        self._world.crowd(count, speed=(slow, fast), avoid=avoid or (), name=name)

    # What happens.

    def _wait(self, seconds: float) -> None:
        self._scenario.sleep(seconds)

    def _drive(self, robot: str, linear: float = 0.0, angular: float = 0.0, seconds: float | None = None) -> None:
        self._model(robot).drive(linear, angular, seconds=seconds)

    def _move(self, model: str, **pose: float) -> None:
        self._model(model).move(**pose)

    def _push(self, model: str, force: list[float], seconds: float = 0.1, link: str | None = None) -> None:
        self._model(model).push(_three(force, "force"), seconds=seconds, link=link)

    def _friction(self, model: str, value: float, link: str | None = None) -> None:
        self._model(model).set_friction(value, link=link)

    def _remove(self, model: str) -> None:
        self._model(model).remove()

    def _disturb(self, topic: str, **impairment: float) -> None:
        self._network.disturb(topic, **impairment)

    def _drop_out(self, topic: str, seconds: float | None = None) -> None:
        self._network.drop_out(topic, seconds)

    def _restore(self, topic: str) -> None:
        self._network.restore(topic)

    def _kill(self, node: str) -> None:
        self._nodes[node].kill()

    def _restart(self, node: str) -> None:
        self._nodes[node].restart()

    def _publish(self, topic: str, type: str, message: Mapping[str, Any] | None = None) -> None:
        from rosidl_runtime_py import set_message_fields
        from rosidl_runtime_py.utilities import get_message

        kind = get_message(type)
        filled = kind()
        set_message_fields(filled, dict(message or {}))
        publisher = self._scenario.node.create_publisher(kind, topic, 10)
        self._scenario.wait_for_graph(lambda: publisher.get_subscription_count() > 0, 10.0)
        publisher.publish(filled)

    def _call(
        self,
        service: str,
        request: Mapping[str, Any] | None = None,
        response: Mapping[str, Any] | None = None,
        tolerance: float = 0.0,
        within: float = 10.0,
    ) -> None:
        from rosidl_runtime_py import set_message_fields
        from rosidl_runtime_py.utilities import get_service

        client = Service(self._scenario, service)
        client.available(within)
        types = dict(self._scenario.node.get_service_names_and_types())
        filled = get_service(types[client.name][0]).Request()
        set_message_fields(filled, dict(request or {}))
        answer = client.send(filled, within=within)
        _check_fields(answer, response, tolerance, f"the response of '{client.name}'")

    def _send(
        self,
        action: str,
        type: str,
        within: float,
        goal: Mapping[str, Any] | None = None,
        result: Mapping[str, Any] | None = None,
        tolerance: float = 0.0,
    ) -> None:
        from rosidl_runtime_py import set_message_fields
        from rosidl_runtime_py.utilities import get_action

        kind = get_action(type)
        filled = kind.Goal()
        set_message_fields(filled, dict(goal or {}))
        client = ActionClient(self._scenario, action, kind)
        _check_fields(client.send_goal(filled, within=within), result, tolerance, f"the result of '{client.name}'")

    # What has to hold.

    def _eventually(self, within: float, **values: Any) -> None:
        signal, wanted = self._assertion(values)
        signal.eventually(within=within, **wanted)

    def _always(self, during: float | None = None, **values: Any) -> None:
        signal, wanted = self._assertion(values)
        signal.always(during=during, **wanted)

    def _never(self, during: float | None = None, **values: Any) -> None:
        signal, wanted = self._assertion(values)
        signal.never(during=during, **wanted)

    def _assertion(self, values: Mapping[str, Any]) -> tuple[Signal, dict[str, Any]]:
        source = {name: value for name, value in values.items() if name in _SOURCE}
        wanted = {name: value for name, value in values.items() if name not in _SOURCE}
        condition(**wanted)  # before anything is waited for
        signal = self._signal(**source)
        return signal, wanted

    def _signal(
        self,
        topic: str | None = None,
        transform: list[str] | None = None,
        robot: str | None = None,
        field: str | None = None,
        of: str = "pose",
        ignore: list[str] | None = None,
        point: list[float] | None = None,
    ) -> Signal:
        given = [name for name in (topic, transform, robot) if name is not None]
        if len(given) != 1:
            raise UserError("an assertion needs one of 'topic', 'transform' and 'robot'")
        signal: Signal
        if topic is not None:
            if topic not in self._topics:
                self._topics[topic] = Topic(self._scenario, topic)
            signal = self._topics[topic]
        elif transform is not None:
            parent, child = transform
            signal = self._transforms.signal(parent, child)
        else:
            signal = self._of_robot(self._model(str(robot)), of, ignore, point)
        return signal if field is None else signal.field(field)

    def _of_robot(self, robot: Robot, of: str, ignore: list[str] | None, point: list[float] | None) -> Signal:
        kinds: dict[str, Callable[[], Signal]] = {
            "pose": lambda: robot.pose,
            "speed": lambda: robot.speed,
            "distance": lambda: robot.distance_to(*(point or (0.0, 0.0))),
            "contacts": lambda: (robot.touched() if ignore is None else robot.touched(ignore)).map(len, "in number"),
        }
        if of not in kinds:
            raise UserError(f"'of' should be one of {', '.join(kinds)}, got '{of}'")
        return kinds[of]()

    def _model(self, name: str) -> Robot:
        return self._world.wait_for(name)

    # What is measured.

    def _follow(self, robot: Robot) -> None:
        """Measure the way of a robot."""
        way = self._ways[robot.name] = [0.0]
        last = [robot.position]

        def add(when: float, pose: Any) -> None:
            way[0] += pose.distance_to(last[0].x, last[0].y)
            last[0] = pose

        robot.pose.listen(add)

    def _measure(self) -> None:
        self._scenario.metrics["time_s"] = round(self._scenario.now, 6)
        for name, way in self._ways.items():
            self._scenario.metrics[f"{name}_distance_m"] = round(way[0], 6)


def _three(values: list[float], name: str) -> tuple[float, float, float]:
    if len(values) != 3:
        raise UserError(f"'{name}' should have 3 numbers, got {len(values)}")
    x, y, z = (float(value) for value in values)
    return x, y, z


def _check_fields(message: Any, wanted: Mapping[str, Any] | None, tolerance: float, what: str) -> None:
    """Raise a failure where fields of a message differ."""
    for path, value in (wanted or {}).items():
        actual = read_field(message, path)
        required = condition(equals=value, tolerance=tolerance)
        if not required.holds(actual):
            raise ScenarioFailure(f"{what}: '{path}' should be {required.text}, but was {actual!r}")


def run_document(scenario: Scenario, path: str) -> None:
    """Run the scenario of a file with the parameters of the run; see `Performance.run`."""
    from daidalos.testing.documents import read_scenario

    Performance(scenario, read_scenario(Path(path), scenario.parameters)).run()
