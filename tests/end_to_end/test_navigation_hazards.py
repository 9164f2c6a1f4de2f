"""Goals that cannot be reached, worlds that change, and faults of the robot, in lock-step."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Any

import pytest
from sensor_msgs.msg import BatteryState

from daidalos.testing.scenario import Scenario
from daidalos.testing.worlds import World
from end_to_end.driving import BLIND_M, Drive

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(600),
    pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals"),
]

BATTERY_TREE = """<root BTCPP_format="4" main_tree_to_execute="Main">
  <BehaviorTree ID="Main">
    <ReactiveSequence>
      <Inverter><IsBatteryLow min_battery="0.2" battery_topic="/battery_status"/></Inverter>
      <PipelineSequence>
        <RateController hz="1.0">
          <ComputePathToPose goal="{goal}" path="{path}" planner_id="GridBased"/>
        </RateController>
        <FollowPath path="{path}" controller_id="FollowPath"/>
      </PipelineSequence>
    </ReactiveSequence>
  </BehaviorTree>
</root>
"""


def error(drive: Drive) -> float:
    """Return how far [m] the robot is from a goal 2 m ahead."""
    return math.dist((drive.robot.position.x, drive.robot.position.y), (2.0, 0.0))


@pytest.mark.scenario(timeout=200, seed=1)
@pytest.mark.parametrize(
    ("x", "y", "code"), [(2.2, 1.1, 206), (10.0, 10.0, 204)], ids=["in a wall", "outside of the map"]
)
def test_a_goal_that_is_no_place(waiting: Drive, x: float, y: float, code: int) -> None:
    waiting.send(x, y)
    assert "was aborted" in waiting.end()
    assert f"error_code={code}" in waiting.failure


@pytest.mark.scenario(timeout=200, seed=1)
def test_an_enclosed_goal(waiting: Drive, world: World, clock: Scenario) -> None:
    for name, x, y, size in (
        ("west", 0.6, 0.0, (0.1, 1.7, 0.5)),
        ("east", 2.2, 0.0, (0.1, 1.7, 0.5)),
        ("south", 1.4, -0.8, (1.4, 0.1, 0.5)),
        ("north", 1.4, 0.8, (1.4, 0.1, 0.5)),
    ):
        world.box(name, x=x, y=y, size=size)
    clock.sleep(2.0)
    waiting.send(1.4, 0.0)
    assert "was aborted" in waiting.end()
    assert "error_code=208" in waiting.failure


@pytest.mark.scenario(timeout=200, seed=1)
def test_a_door_that_closes(waiting: Drive, world: World) -> None:
    waiting.start(2.6, -1.9)
    waiting.robot.distance_to(1.5, -1.38).eventually(below=0.9, within=60.0)
    world.box("door", x=1.5, y=-1.38, size=(0.1, 0.82, 0.5))
    assert waiting.end() == ""
    assert math.dist((waiting.robot.position.x, waiting.robot.position.y), (2.6, -1.9)) < 0.35


@pytest.mark.scenario(timeout=120, seed=1)
@pytest.mark.parametrize("speed", [0.3, 0.4, 0.6, 1.0])
def test_a_box_that_crosses_the_way_is_not_touched(drive: Drive, world: World, clock: Scenario, speed: float) -> None:
    y = 1.3
    box = world.box("box", x=1.3, y=y, size=(0.4, 0.4, 0.5))
    while y > -0.6:
        clock.sleep(0.02)
        y -= 0.02 * speed
        box.move(1.3, y)
    assert drive.end() == ""
    assert error(drive) < 0.35


@pytest.mark.scenario(timeout=200, seed=1)
def test_wheels_that_slip(drive: Drive) -> None:
    drive.robot.set_friction(0.05)
    drive.end()
    if not drive.failure:
        assert error(drive) < 0.35


@pytest.mark.scenario(timeout=200, seed=1)
def test_a_low_battery(waiting: Drive, clock: Scenario, tmp_path: Path) -> None:
    tree = tmp_path / "battery.xml"
    tree.write_text(BATTERY_TREE)
    publisher = clock.node.create_publisher(BatteryState, "/battery_status", 10)
    waiting.start(tree=str(tree))
    publisher.publish(BatteryState(percentage=0.15))
    assert waiting.distance_in(4.0) < BLIND_M
    assert "was aborted" in waiting.end()


@pytest.mark.scenario(timeout=200, seed=1)
def test_a_clock_that_is_reset(drive: Drive, service: Any) -> None:
    service("/reset_simulation").call(within=5.0)  # the robot stands at the start again
    if not drive.end():
        assert error(drive) < 0.35
