"""BARN (Perille et al. 2020): a robot crosses fields of posts without a map, in lock-step; its worlds and its score."""

from __future__ import annotations

import hashlib
import math
import re
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.errors import UserError
from daidalos.testing.journal import Record
from daidalos.testing.processes import ScenarioProcess, scenario_environment
from daidalos.testing.server import Request
from daidalos.testing.single import PICTURES, RESULT, carry_out

if TYPE_CHECKING:
    from daidalos.testing.scenario import Scenario

START = (-2.0, 3.0, 0.5 * math.pi)
"""Pose of the robot at the start [m, rad]."""

AHEAD_M = 10.0
"""Distance of the goal, straight ahead."""

WITHIN_M = 1.0
"""Distance of the goal at which it is reached."""

LIMIT_S = 100.0
TOP_SPEED = 2.0
"""Speed of the optimal time [m/s]."""

LATENCY_S = 0.03
"""Time that a command takes to the motors."""

_CELL = 0.15
_CORNER = (-4.575, 5.075)
_FIRST_POST = np.array([-4.425, 0.075])
_BRING_UP_S = 60.0
_POST_M = 1.0


@dataclass(frozen=True)
class BarnWorld:
    """One world.

    Parameters
    ----------
    number : int
    posts : array (n, 2)
        Centres [m].
    radius : float
        Of the posts [m].
    optimal_time : float
        Of the shortest way at the robot's top speed [s].
    """

    number: int
    posts: Array
    radius: float
    optimal_time: float

    def score(self, time: float, fastest: float) -> float:
        """Return the score of a run that has reached the goal in some time [s]: at most ``1 / fastest``."""
        return self.optimal_time / min(max(time, fastest * self.optimal_time), 8.0 * self.optimal_time)

    def sdf(self) -> str:
        """Return the world as SDF."""
        shape = (
            f"<geometry><cylinder><radius>{self.radius:g}</radius><length>{_POST_M:g}</length></cylinder></geometry>"
        )
        posts = "".join(
            f'<collision name="c{i}"><pose>{x:.4f} {y:.4f} {0.5 * _POST_M:g} 0 0 0</pose>{shape}</collision>'
            f'<visual name="v{i}"><pose>{x:.4f} {y:.4f} {0.5 * _POST_M:g} 0 0 0</pose>{shape}</visual>'
            for i, (x, y) in enumerate(self.posts.tolist())
        )
        return _SDF.format(number=self.number, posts=posts, plane=_PLANE)


_PLANE = "<plane><normal>0 0 1</normal><size>40 40</size></plane>"
_SDF = """<?xml version="1.0"?>
<sdf version="1.9">
  <world name="barn_{number:03d}">
    <physics name="default" type="ode"><max_step_size>0.002</max_step_size></physics>
    <include><uri>model://sun</uri></include>
    <model name="ground_plane"><static>true</static><link name="link">
      <collision name="collision"><geometry>{plane}</geometry></collision>
      <visual name="visual"><geometry>{plane}</geometry></visual>
    </link></model>
    <model name="posts"><static>true</static><link name="link">{posts}</link></model>
  </world>
</sdf>
"""


def read_worlds(path: Path) -> dict[int, BarnWorld]:
    """Read the worlds of a file, by number.

    Parameters
    ----------
    path : Path
        A file of numpy (.npz): ``cylinder_xy`` (n, 2) and ``radius`` [m] of all posts, those of the k-th world from
        ``offsets[k]`` to ``offsets[k + 1]``, and for each world ``path_NNN`` (m, 2), its shortest way in cells of
        0.15 m.

    Raises
    ------
    UserError
    """
    try:
        with np.load(path, allow_pickle=False) as data:
            arrays: dict[str, Array] = {name: np.asarray(data[name]) for name in data.files}
    except (OSError, ValueError, EOFError, KeyError) as error:
        raise UserError(f"{path}: expected a file of numpy with BARN worlds (.npz): {error}") from None
    for name in ("cylinder_xy", "offsets", "radius"):
        if name not in arrays:
            raise UserError(f"{path}: expected an array '{name}', got {', '.join(arrays) or 'none'}")
    paths = {int(name.removeprefix("path_")): name for name in sorted(arrays) if re.fullmatch(r"path_\d+", name)}
    _check_arrays(path, arrays, list(paths.values()))
    offsets, posts = arrays["offsets"].astype(int), arrays["cylinder_xy"].astype(float)
    return {
        number: BarnWorld(
            number,
            posts[offsets[index] : offsets[index + 1]],
            float(arrays["radius"]),
            optimal_time(arrays[name]),
        )
        for index, (number, name) in enumerate(sorted(paths.items()))
    }


def _check_arrays(file: Path, arrays: Mapping[str, Array], paths: Sequence[str]) -> None:
    """Raise an error where an array of a file of worlds is not as it should be."""
    for name in ("cylinder_xy", *paths):
        if arrays[name].ndim != 2 or arrays[name].shape[1] != 2:
            raise UserError(f"{file}: '{name}' should have two columns, got an array of {arrays[name].shape}")
    for name in ("cylinder_xy", "radius", *paths):
        if arrays[name].dtype.kind not in "fiu" or not np.isfinite(arrays[name]).all():
            raise UserError(f"{file}: '{name}' should be finite numbers")
    if arrays["radius"].size != 1 or not float(arrays["radius"]) > 0.0:
        raise UserError(f"{file}: 'radius' should be positive, got {arrays['radius']}")
    offsets = arrays["offsets"]
    if len(offsets) != len(paths) + 1:
        raise UserError(f"{file}: expected an offset more than paths, got {len(offsets)} and {len(paths)}")
    count = len(arrays["cylinder_xy"])
    if offsets[0] != 0 or offsets[-1] != count or (np.diff(offsets) < 0).any():
        raise UserError(f"{file}: expected offsets that rise from 0 to {count}")


def optimal_time(cells: Array) -> float:
    """Return the time [s] of the way from the start over some cells (m, 2) to the goal."""
    points = np.concatenate([[START[:2]], cells * _CELL + _CORNER, [(START[0], START[1] + AHEAD_M)]])
    return float(np.hypot(*np.diff(points, axis=0).T).sum()) / TOP_SPEED


def random_world(number: int) -> BarnWorld:
    """Return a world of a random field in the manner of BARN's."""
    from daidalos.testing.barn_fields import SIZE, WALL_ROWS, random_field

    field, path = random_field(number)
    walls = np.zeros((WALL_ROWS, SIZE), dtype=bool)
    walls[:, (0, -1)] = walls[0] = True
    rows, columns = np.nonzero(np.concatenate([walls, field]))
    posts = np.stack([columns * _CELL, rows * _CELL], axis=-1) + _FIRST_POST
    return BarnWorld(number, posts, 0.5 * _CELL, optimal_time(path))


@dataclass(frozen=True)
class BarnPlan:
    """What results of BARN belong to.

    Parameters
    ----------
    worlds : Path or None
        File of the worlds; None for random ones.
    params_file : Path or None
        Parameters of navigation; None for those of the package.
    seed : int
        Added to the numbers of the worlds.
    """

    worlds: Path | None = None
    params_file: Path | None = None
    seed: int = 0

    def identity(self) -> dict[str, Any]:
        """Return what makes results belong to this plan, as plain data; more worlds may be added to it."""
        files = {"worlds": self.worlds, "params_file": self.params_file}
        digests = {
            name: "" if file is None else hashlib.sha256(file.read_bytes()).hexdigest() for name, file in files.items()
        }
        return {"scenario": "BARN", "seed": self.seed, **digests}


def cross(process: ScenarioProcess, world: BarnWorld, plan: BarnPlan, results: Path) -> Record:
    """Carry out the run in one world; the picture of a failure is kept below a folder."""
    begun = time.perf_counter()
    seed = plan.seed + world.number
    name = f"barn-{world.number:03d}"

    def request_of(folder: Path) -> Request:
        path = folder / "world.sdf"
        path.write_text(world.sdf(), encoding="utf-8")
        params_file = "" if plan.params_file is None else str(plan.params_file.resolve())
        arguments = {"world": str(path), "name": name, "result": str(folder / RESULT), "params_file": params_file}
        return Request(
            "daidalos.testing.barn:perform",
            arguments,
            seed,
            _BRING_UP_S * 2 + LIMIT_S,
            str(folder),
            str(Path.cwd()),
            scenario_environment(),
            tuple(sys.path),
            {},
            False,
            quiet=True,
        )

    done = carry_out(process, request_of, results / PICTURES / name)
    taken = done.metrics.get("time_s", math.inf)
    metrics = {
        **done.metrics,
        "optimal_time_s": round(world.optimal_time, 6),
        "score": world.score(taken, 4.0) if done.passed else 0.0,
        "strict_score": world.score(taken, 2.0) if done.passed else 0.0,
    }
    return Record(
        world.number,
        seed,
        {},
        done.passed,
        done.message,
        done.simulated_s,
        round(time.perf_counter() - begun, 3),
        metrics,
        "" if done.folder is None else done.folder.relative_to(results).as_posix(),
    )


def perform(scenario: Scenario, world: str, name: str, result: str, params_file: str = "") -> int:
    """Cross a world, and write the result as JSON; called in the process of the scenario.

    Parameters
    ----------
    scenario : Scenario
    world : str
        Path of the SDF file.
    name : str
        Title of the picture of a failure.
    result : str
        Path of the result.
    params_file : str
        Parameters of navigation; those of the package where empty.
    """
    from daidalos.testing.single import write_report

    write_report(scenario, lambda: _cross(scenario, world, params_file), name, Path(result))
    return 0


def _cross(scenario: Scenario, path: str, params_file: str) -> None:
    """Bring the robot up at its start, and send it to the goal; the time counts from there."""
    from geometry_msgs.msg import PoseStamped
    from nav2_msgs.action import NavigateToPose

    from daidalos.testing.graph import ActionClient, Transforms
    from daidalos.testing.network import Network
    from daidalos.testing.programs import Nodes
    from daidalos.testing.scenario import ScenarioFailure
    from daidalos.testing.worlds import World

    nodes = Nodes(scenario)
    world = World(scenario, nodes)
    own = {"params_file": params_file} if params_file else {}
    nodes.launch("daidalos_barn", "barn.launch.py", world=path, seed=scenario.seed, **own)
    robot = world.wait_for("jackal")
    robot.never_touches()
    distance = robot.distance_to(START[0], START[1] + AHEAD_M)
    Transforms(scenario).signal("odom", "base_link").wait(_BRING_UP_S)
    Network(scenario).disturb("/cmd_vel", latency=LATENCY_S)
    goal = PoseStamped()
    goal.header.frame_id = "odom"
    goal.pose.position.x, goal.pose.orientation.w = AHEAD_M, 1.0
    client = ActionClient(scenario, "/navigate_to_pose", NavigateToPose)
    ended = client.start_goal(NavigateToPose.Goal(pose=goal), within=_BRING_UP_S)
    begun = scenario.now

    def is_there() -> bool:
        return bool(distance.values) and distance.values[-1][1] < WITHIN_M

    try:
        came = scenario.wait(lambda: is_there() or ended.done(), LIMIT_S)
    finally:
        scenario.metrics["time_s"] = round(scenario.now - begun, 6)
    if not is_there():
        how = f"the goal was given up: {ended.result().result.error_msg}" if came else f"not there after {LIMIT_S:g} s"
        raise ScenarioFailure(f"{how}; {distance.values[-1][1]:.1f} m from the goal")
