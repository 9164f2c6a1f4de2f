"""Scenarios as users write them: this module's tests run in lock-step by the plugin."""

import os
from pathlib import Path
from typing import Any

import pytest
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node
from std_msgs.msg import String

from daidalos.testing.network import Network
from daidalos.testing.programs import Nodes
from daidalos.testing.scenario import Scenario, ScenarioFailure
from daidalos.testing.worlds import World

pytestmark = pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals")


class Adder(Node):
    def __init__(self) -> None:
        super().__init__("adder")
        self.create_service(AddTwoInts, "add", self.add)

    def add(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        response.sum = request.a + request.b
        return response


class Counter(Node):
    """Publisher of numbers, ten a second."""

    def __init__(self) -> None:
        super().__init__("counter")
        self.count = 0
        self.publisher = self.create_publisher(String, "count", 10)
        self.create_timer(0.1, self.publish)

    def publish(self) -> None:
        self.count += 1
        self.publisher.publish(String(data=str(self.count)))


class Relay(Node):
    """Repeats what it hears."""

    def __init__(self) -> None:
        super().__init__("relay")
        self.publisher = self.create_publisher(String, "heard", 10)
        self.create_subscription(String, "count", self.publisher.publish, 10)


LAUNCH = """<launch><node pkg="demo_nodes_py" exec="talker" namespace="{0}"/></launch>"""


@pytest.mark.slow
@pytest.mark.scenario(timeout=20)
def test_launch_files_run_beside_one_another(launch: Any, topic: Any, tmp_path: Path) -> None:
    for side in ("left", "right"):
        path = tmp_path / f"{side}.launch.xml"
        path.write_text(LAUNCH.format(side))
        launch(path)
    for side in ("left", "right"):
        assert topic(f"/{side}/chatter").wait(4).data.startswith("Hello")


@pytest.mark.slow
@pytest.mark.scenario(timeout=20)
def test_a_launch_that_fails_fails_the_test(launch: Any, clock: Scenario) -> None:
    launch("demo_nodes_py", "nothing.launch.py")
    with pytest.raises(ScenarioFailure, match=r"(?s)launch of 'nothing.launch.py' ended with exit status 2.*not found"):
        clock.sleep(1.0)


@pytest.mark.slow
@pytest.mark.scenario(timeout=60, seed=3)
def test_topics_services_and_programs(
    nodes: Nodes, topic: Any, service: Any, clock: Scenario, network: Network
) -> None:
    assert (clock.now, clock.seed) == (0.0, 3)
    talker = nodes.run("demo_nodes_py", "talker", name="speaker", namespace="left")
    chatter = topic("/left/chatter")
    assert chatter.eventually(lambda message: message.data.endswith("2"), within=4).data == "Hello World: 2"
    assert chatter.rate(during=3) == pytest.approx(1.0, abs=0.34)
    chatter.field("data").always(lambda text: text.startswith("Hello"), during=1.5)
    with pytest.raises(
        ScenarioFailure, match=r"(?s)/left/chatter data should never be as the function requires.*Hello"
    ):
        chatter.field("data").never(lambda text: text.endswith("7"), during=5)
    assert "Hello World: 1" in talker.prints(r"World: 1", within=1)
    talker.kill()
    assert not talker.is_alive
    with pytest.raises(ScenarioFailure, match=r"no value came within 3 s \(from"):
        chatter.wait(3)
    nodes["speaker"].restart()
    chatter.eventually(lambda message: message.data == "Hello World: 1", within=5)

    nodes.add(Adder)
    assert service("add").call(a=2, b=3, within=1).sum == 5
    with pytest.raises(ScenarioFailure, match=r"no service '/ad' within 1 s; did you mean '/add'\?"):
        service("/ad").call(within=1)

    nodes.add(Counter)
    nodes.add(Relay)
    heard, count = topic("heard"), topic("/count")
    heard.wait(1)
    network.disturb("/count", latency=0.5)
    clock.sleep(1)
    late = int(count.value.data) - int(heard.value.data)
    assert late in (5, 6)
    network.disturb("/count", loss=0.5)
    clock.sleep(0.6)
    assert 2.5 <= heard.rate(during=2) <= 7.5
    network.drop_out("/count", 1.0)
    clock.sleep(0.5)
    assert heard.rate(during=0.4) == 0.0
    clock.sleep(0.2)
    assert heard.rate(during=1.0) == pytest.approx(10.0, abs=1.0)
    network.alter("/count", lambda message: setattr(message, "data", "another"))
    heard.eventually(lambda message: message.data == "another", within=0.5)
    assert count.value.data != "another"


@pytest.mark.slow
@pytest.mark.scenario(timeout=60, seed=1, world="arena")
def test_worlds_and_their_disturbances(world: World, robot: Any, transform: Any, topic: Any, clock: Scenario) -> None:
    assert robot.name == "waffle"
    robot.drive(0.25)
    robot.pose.eventually(x=0.5, y=0.0, yaw=0.0, tolerance=0.05, within=5)
    transform("odom", "base_footprint").eventually(x=0.6, tolerance=0.03, within=5)
    ahead = topic("/scan").map(lambda scan: scan.ranges[len(scan.ranges) // 2], "ahead")
    free = ahead.value
    box = world.box("crate", x=robot.position.x + 1.0, y=0.0)
    ahead.eventually(below=min(free, 1.0), within=1)
    robot.touched().eventually(("crate",), within=10)
    robot.drive(0.0)
    box.remove()
    ahead.eventually(above=1.5, within=1)
    world.walk("guard", [(1.5, -1.0), (1.5, 1.0)], speed=1.0)
    world["guard"].pose.eventually(x=1.5, y=1.0, tolerance=0.1, within=5)
    world["guard"].pose.eventually(x=1.5, y=-1.0, tolerance=0.1, within=5)
    robot.move(-2.0, 0.0)
    robot.pose.eventually(x=-2.0, tolerance=0.01, within=0.2)
    robot.push((400.0, 0.0, 0.0), seconds=0.2)
    robot.speed.eventually(above=0.5, within=1)
    with pytest.raises(Exception, match=r"no model 'wafle' in the world; did you mean 'waffle'"):
        world["wafle"]
    # Without friction of the wheels nothing drives.
    robot.set_friction(0.0)
    robot.speed.eventually(below=0.01, within=20)


@pytest.mark.slow
@pytest.mark.scenario
@pytest.mark.parametrize("word", ["one", "two"])
def test_the_usual_fixtures_and_parameters_work(word: str, tmp_path: Any, clock: Scenario) -> None:
    (tmp_path / word).write_text(word)
    clock.sleep(3600 if word == "no" else 30)
    assert clock.now == 30.0
