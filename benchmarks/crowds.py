"""A robot among 20 people at 0.6 to 1.4 m/s in the arena, in lock-step: goals reached, and contacts while it moves.

``DAIDALOS_BENCHMARK_CROWD`` is the number of goals, 100 by default.
"""

from __future__ import annotations

import json
import math
import os
import statistics
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from ament_index_python.packages import get_package_share_directory

from daidalos.mapping.grid import OccupancyGrid
from daidalos.mapping.map_file import save_map
from daidalos.testing.processes import ScenarioProcess, scenario_environment
from daidalos.testing.server import Request

if TYPE_CHECKING:
    from daidalos.simulation import Simulation
    from daidalos.testing.scenario import Scenario

GOALS = int(os.environ.get("DAIDALOS_BENCHMARK_CROWD", "100"))
PEOPLE = 20
SPEEDS = (0.6, 1.4)
LIMIT_S = 180.0
CLEARANCE = 0.45
RESOLUTION = 0.05
NO_OBSTACLES = ("waffle", "ground_plane")
AMCL = {
    "laser_model_type": "likelihood_field_prob",
    "do_beamskip": True,
    "beam_skip_error_threshold": 0.95,
    "beam_skip_distance": 0.2,
    "max_beams": 180,
    **{f"alpha{number}": 0.05 for number in range(1, 5)},
    "recovery_alpha_slow": 0.0,
    "recovery_alpha_fast": 0.0,
}
"""Beams that end at people make AMCL look nowhere else."""

STANDS = 0.02
"""Speed [m/s] below which the robot does not move."""


def run() -> dict[str, float | str]:
    """Send the robot to all goals."""
    with tempfile.TemporaryDirectory() as name, ScenarioProcess() as process:
        result = Path(name) / "result.jsonl"
        arguments = {"result": str(result), "goals": GOALS, "people": PEOPLE}
        environment = scenario_environment()
        path = (str(Path(__file__).parents[1]), *sys.path)
        target = "benchmarks.crowds:perform"
        request = Request(target, arguments, 1, GOALS * LIMIT_S, name, name, environment, path, {}, False, quiet=True)
        process.run(request)
        rows = [json.loads(line) for line in result.read_text().splitlines()]
    return figures(rows)


def figures(rows: list[dict[str, float]]) -> dict[str, float | str]:
    """Return the figures of some goals."""
    reached = [row for row in rows if row["reached"]]
    return {
        "crowd.goals": float(len(rows)),
        "crowd.reached_percent": 100.0 * len(reached) / max(len(rows), 1),
        "crowd.contacts_while_it_moves": sum(row["contacts"] for row in rows),
        "crowd.contacts_while_it_stands": sum(row["standing_contacts"] for row in rows),
        "crowd.mean_time_s": statistics.fmean(row["time_s"] for row in reached) if reached else math.nan,
    }


def map_of(simulation: Simulation) -> OccupancyGrid:
    """Return a map of what stands in a simulation."""
    from shapely import Polygon, contains_xy, unary_union

    from daidalos.testing.pictures import outlines

    solid = unary_union([Polygon(shape) for owner, shape in outlines(simulation) if owner not in NO_OBSTACLES])
    left, low, right, high = solid.buffer(0.2).bounds
    x, y = (np.arange(start, end, RESOLUTION) + 0.5 * RESOLUTION for start, end in ((left, right), (low, high)))
    cells = contains_xy(solid.buffer(0.3 * RESOLUTION), *np.meshgrid(x, y))
    return OccupancyGrid(np.where(cells, 100, 0).astype(np.int8), RESOLUTION, (left, low, 0.0))


def crowd_parameters() -> str:
    """Return the default parameters, changed for a place with many people.

    They do not close ways, the robot waits for them, and beams that end at them do not make AMCL look elsewhere.
    """
    import yaml

    path = Path(get_package_share_directory("nav2_bringup")) / "params" / "nav2_params.yaml"
    content = yaml.safe_load(path.read_text())
    content["global_costmap"]["global_costmap"]["ros__parameters"]["plugins"] = ["static_layer", "inflation_layer"]
    controller = content["controller_server"]["ros__parameters"]
    controller["progress_checker"]["movement_time_allowance"] = 60.0
    controller["failure_tolerance"] = 30.0
    content["amcl"]["ros__parameters"] |= AMCL
    text: str = yaml.safe_dump(content)
    return text


def set_initial_pose(scenario: Scenario) -> None:
    """Publish the origin as the initial pose of AMCL."""
    from geometry_msgs.msg import PoseWithCovarianceStamped

    pose = PoseWithCovarianceStamped()
    pose.header.frame_id = "map"
    pose.pose.pose.orientation.w = 1.0
    publisher = scenario.node.create_publisher(PoseWithCovarianceStamped, "/initialpose", 10)
    scenario.wait(lambda: publisher.get_subscription_count() > 0, 60.0)
    publisher.publish(pose)


def perform(scenario: Scenario, result: str, goals: int, people: int) -> int:
    """Drive among the people, and write a line for each goal; called in the process of the scenario."""
    from geometry_msgs.msg import PoseStamped
    from nav2_msgs.action import NavigateToPose

    from daidalos.testing.crowds import ground_of
    from daidalos.testing.graph import ActionClient, Transforms
    from daidalos.testing.programs import Nodes
    from daidalos.testing.scenario import ScenarioFailure
    from daidalos.testing.worlds import World

    nodes = Nodes(scenario)
    world = World(scenario, nodes)
    nodes.launch("turtlebot3_gazebo", "turtlebot3_arena.launch.py")
    robot = world.wait_for("waffle")
    plan = Path(result).with_name("arena.yaml")
    save_map(world.read(map_of), plan)
    parameters = Path(result).with_name("crowd.yaml")
    parameters.write_text(crowd_parameters())
    ground = world.read(lambda simulation: ground_of(simulation, NO_OBSTACLES))
    world.crowd(people, speed=SPEEDS, avoid=("waffle",))
    nodes.launch(
        "nav2_bringup", "bringup_launch.py", use_sim_time=True, map=plan, params_file=parameters, use_composition=False
    )
    set_initial_pose(scenario)
    Transforms(scenario).signal("map", "base_link").wait(60.0)
    places = ground.places()
    rows, columns = np.nonzero(ground.free)
    places = places[ground.distance[rows, columns] > CLEARANCE]
    monitor = world.read(lambda simulation: simulation.monitor_contacts("waffle", ("ground_plane", "ground")))
    believed = Transforms(scenario).signal("map", "base_footprint")

    def localization_error() -> float:
        pose = believed.value
        return math.hypot(robot.position.x - pose.x, robot.position.y - pose.y)

    touched: list[tuple[int, float]] = []

    def look(_: float, speed: float) -> None:
        seen = len(touched)
        touched.extend((touch.first_ns, speed) for touch in monitor.touches[seen:])

    robot.speed.listen(look)
    client = ActionClient(scenario, "/navigate_to_pose", NavigateToPose)
    stream = np.random.default_rng(scenario.seed)
    with Path(result).open("w") as file:
        for _ in range(goals):
            x, y = places[stream.integers(len(places))].tolist()
            pose = PoseStamped()
            pose.header.frame_id = "map"
            pose.pose.position.x, pose.pose.position.y, pose.pose.orientation.w = x, y, 1.0
            begun, before, failure = scenario.now, len(touched), ""
            try:
                client.send_goal(NavigateToPose.Goal(pose=pose), within=LIMIT_S)
            except ScenarioFailure as problem:
                failure = str(problem)
            new = [speed for _, speed in touched[before:]]
            away = math.hypot(robot.position.x - x, robot.position.y - y)
            row = {
                "reached": not failure and away < 0.5,
                "contacts": sum(speed >= STANDS for speed in new),
                "standing_contacts": sum(speed < STANDS for speed in new),
                "time_s": scenario.now - begun,
                "away_m": away,
                "localization_error_m": localization_error(),
                "failure": failure[:200],
            }
            file.write(json.dumps(row) + "\n")
            file.flush()
    return 0
