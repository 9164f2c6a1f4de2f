"""People of crowds: forces, ways around obstacles, and distances that they keep."""

import math
import os
from pathlib import Path

import numpy as np
import pytest

from daidalos.common.errors import UserError
from daidalos.testing.crowds import PERSON_RADIUS, ROBOT_RADIUS, STEP_S, Crowd, Grounds
from daidalos.testing.documents import read_scenario
from daidalos.testing.programs import Nodes
from daidalos.testing.scenario import Scenario
from daidalos.testing.social_forces import Bodies, accelerations, walk
from daidalos.testing.worlds import World

NOBODY = Bodies(np.zeros((0, 2)), np.zeros(0))


def box(x: float, y: float, width: float, depth: float) -> list[tuple[float, float]]:
    return [(x, y), (x + width, y), (x + width, y + depth), (x, y + depth)]


@pytest.fixture(scope="module")
def ground() -> Grounds:
    """Two rooms of 4 x 4 m with a door of 1.2 m between them."""
    walls = [
        *(box(0.0, -0.2, 8.2, 0.2), box(0.0, 4.0, 8.2, 0.2)),
        *(box(-0.2, -0.2, 0.2, 4.4), box(8.2, -0.2, 0.2, 4.4)),
        *(box(4.0, 0.0, 0.2, 1.4), box(4.0, 2.6, 0.2, 1.4)),
    ]
    return Grounds(walls)


def test_somebody_alone_gets_to_the_wanted_speed() -> None:
    person = Bodies(np.zeros((1, 2)), np.array([0.25]))
    wanted, velocity = np.array([[1.0, 0.0]]), np.zeros((1, 2))
    for _ in range(round(0.5 / 0.01)):
        push = accelerations(person, velocity, wanted, NOBODY, np.full(1, 9.0), np.zeros((1, 2)))
        velocity = walk(person, velocity, push, np.ones(1), NOBODY, 0.01)
    assert velocity[0] == pytest.approx([1.0 - math.exp(-1.0), 0.0], abs=0.01)


def test_two_who_meet_push_each_other_apart_and_to_the_right() -> None:
    people = Bodies(np.array([[0.0, 0.0], [0.8, 0.0]]), np.full(2, 0.25))
    still = np.zeros((2, 2))
    push = accelerations(people, still, still, NOBODY, np.full(2, 9.0), still)
    assert push[0, 0] < 0.0 < push[1, 0]
    assert push[0] == pytest.approx(-push[1])
    assert push[0, 1] > 0.0 > push[1, 1] or push[0, 1] < 0.0 < push[1, 1]


def test_a_wall_pushes_away() -> None:
    person = Bodies(np.zeros((1, 2)), np.array([0.25]))
    still = np.zeros((1, 2))
    normal = np.array([[0.0, 1.0]])
    near, far = (accelerations(person, still, still, NOBODY, np.array([d]), normal)[0, 1] for d in (0.3, 0.8))
    assert near > 10.0 * far > 0.0


@pytest.mark.parametrize("speed", [0.6, 1.4])
def test_nobody_walks_into_a_robot_that_stands(speed: float) -> None:
    robot = Bodies(np.array([[2.0, 0.0]]), np.array([0.24]))
    people, velocity = Bodies(np.zeros((1, 2)), np.array([0.25])), np.array([[speed, 0.0]])
    for _ in range(300):
        push = np.array([[5.0, 0.0]])  # pressed against it
        velocity = walk(people, velocity, push, np.array([speed]), robot, 0.02)
        people = Bodies(people.positions + 0.02 * velocity, people.radii)
    gap = 2.0 - people.positions[0, 0] - 0.49
    assert 0.05 < gap < 0.15


def test_ways_lead_through_the_door(ground: Grounds) -> None:
    start, end = np.array([2.0, 0.8]), np.array([6.0, 0.8])
    ways = ground.ways_to(end)
    position, through = start.copy(), []
    for _ in range(200):
        position = position + 0.05 * ground.directions(position[None], [ways])[0]
        through.append(position.copy())
        if np.hypot(*(position - end)) < 0.3:
            break
    assert np.hypot(*(position - end)) < 0.3
    crossing = min(through, key=lambda point: abs(point[0] - 4.1))
    assert 1.4 < crossing[1] < 2.6


def test_a_crowd_keeps_away_from_walls_and_from_a_robot(ground: Grounds) -> None:
    names = [f"person_{number}" for number in range(8)]
    robot = np.array([[4.1, 2.0]])  # in the door
    crowd = Crowd(names, ground, ["robot"], (0.6, 1.4), 1, robot)
    nearest_wall, nearest_robot, walked = math.inf, math.inf, np.zeros(8)
    for _ in range(round(20.0 / STEP_S)):
        before = crowd.positions
        crowd.move(robot)
        walked += np.hypot(*(crowd.positions - before).T)
        nearest_wall = min(nearest_wall, float(ground.walls(crowd.positions)[0].min()))
        nearest_robot = min(nearest_robot, float(np.hypot(*(crowd.positions - robot).T).min()))
    assert nearest_wall > PERSON_RADIUS - 0.15
    assert nearest_robot > PERSON_RADIUS + ROBOT_RADIUS + 0.02
    assert walked.mean() > 5.0


def test_the_same_seed_walks_the_same_way(ground: Grounds) -> None:
    crowds = [Crowd(["a", "b"], ground, [], (1.0, 1.0), seed, np.zeros((0, 2))) for seed in (3, 3, 4)]
    for crowd in crowds:
        for _ in range(50):
            crowd.move(np.zeros((0, 2)))
    assert np.array_equal(crowds[0].positions, crowds[1].positions)
    assert not np.array_equal(crowds[0].positions, crowds[2].positions)


def test_a_step_of_a_scenario(tmp_path: Path) -> None:
    path = tmp_path / "crowd.yaml"
    path.write_text("steps:\n  - crowd: {count: 5, speed: [0.6, 1.4], avoid: [waffle]}\n")
    assert read_scenario(path).steps[0].values == {"count": 5, "speed": [0.6, 1.4], "avoid": ["waffle"]}
    path.write_text("steps:\n  - crowd: {speed: [0.6, 1.4]}\n")
    with pytest.raises(UserError, match="needs 'count'"):
        read_scenario(path)


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals")
@pytest.mark.scenario(timeout=30, seed=2)
def test_people_walk_around_a_robot_that_stands(scenario: Scenario) -> None:
    world = World(scenario, Nodes(scenario))
    world.load("arena")
    robot = world.spawn("waffle")
    robot.never_touches()
    for count, speed in ((0, (0.6, 1.4)), (3, (1.4, 0.6)), (500, (0.6, 1.4))):
        with pytest.raises(UserError):
            world.crowd(count, speed=speed)
    world.crowd(10, avoid=["waffle"])
    before = [world[f"person_{number}"].position for number in range(10)]
    scenario.sleep(10.0)
    after = [world[f"person_{number}"].position for number in range(10)]
    assert sum(a.distance_to(b.x, b.y) > 0.3 for a, b in zip(after, before, strict=True)) >= 8
