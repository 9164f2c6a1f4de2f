"""The server that smooths paths, over a costmap that the test publishes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Duration
from nav2_msgs.action import SmoothPath
from nav_msgs.msg import Path
from rclpy.lifecycle import TransitionCallbackReturn

from daidalos.navigation.costmap.costmap import Costmap
from daidalos.nodes.conversions import path_array, path_message
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_message
from daidalos.nodes.nav2_smoother.smoother_server import SmootherServer
from nodes.stepped import LATCHED, Stage

pytestmark = [pytest.mark.usefixtures("compiled"), pytest.mark.timeout(300)]

Result = SmoothPath.Result
PARAMETERS: dict[str, Any] = {
    "/smoother_server": {
        "smoother_plugins": ["simple_smoother", "other", "constrained"],
        "simple_smoother": {
            "plugin": "nav2_smoother::SimpleSmoother", "tolerance": 1e-10, "max_its": 1000, "do_refinement": True
        },
        "other": {"plugin": "nav2_smoother::SavitzkyGolaySmoother", "window_size": 5},
        "constrained": {
            "plugin": "nav2_constrained_smoother/ConstrainedSmoother", "w_smooth": 30.0, "minimum_turning_radius": 0.3,
            "path_downsampling_factor": 2, "optimizer": {"max_iterations": 70, "fn_tol": 1e-15},
        },
    },
}  # fmt: skip


class Bench:
    def __init__(self, stage: Stage, *, has_costmap: bool = True) -> None:
        self.stage = stage
        self.server = stage.add(SmootherServer())
        assert self.server.trigger_configure() == TransitionCallbackReturn.SUCCESS
        assert self.server.trigger_activate() == TransitionCallbackReturn.SUCCESS
        if has_costmap:
            costmap = Costmap.filled(80, 80, 0.05, (0.0, 0.0))
            costmap.costs[:, 60:] = 254
            stage.publish("/global_costmap/costmap_raw", costmap_message(costmap, "map", stage.stamp), LATCHED)

    def smooth(self, poses: Any, frame: str = "map", **goal: Any) -> tuple[int, Any]:
        goal.setdefault("max_smoothing_duration", Duration(sec=5))
        path = path_message(np.array(poses, float).reshape(-1, 3), frame, self.stage.stamp)
        return self.stage.end(self.stage.send(SmoothPath, "smooth_path", path=path, **goal))


def corner(end: float = 2.0) -> list[tuple[float, float, float]]:
    ahead = [(x, 1.0, 0.0) for x in np.arange(1.0, 2.0, 0.05)]
    return [*ahead, *((end, y, 1.57) for y in np.arange(1.0, 2.0, 0.05))]


@pytest.mark.parametrize("name", ["", "other", "constrained"])
def test_a_path_is_smoothed(stage: Callable[[dict[str, Any]], Stage], name: str) -> None:
    bench = Bench(stage(PARAMETERS))
    published = bench.stage.collect(Path, "plan_smoothed")
    status, result = bench.smooth(corner(), smoother_id=name, check_for_collisions=True)
    assert (status, result.error_code, result.was_completed) == (GoalStatus.STATUS_SUCCEEDED, Result.NONE, True)
    given, smoothed = np.array(corner()), path_array(result.path)
    assert smoothed[[0, -1]] == pytest.approx(given[[0, -1]], abs=1e-3)
    bends = [np.abs(np.diff(np.diff(path[:, :2], axis=0), axis=0)).max() for path in (given, smoothed)]
    assert bends[1] < 0.7 * bends[0]
    assert result.path.header.frame_id == "map"
    bench.stage.step_until(lambda: bool(published))


@pytest.mark.parametrize(
    ("poses", "goal", "code", "reason"),
    [
        (corner(), {"smoother_id": "Simple"}, Result.INVALID_SMOOTHER, "simple_smoother, other, constrained"),
        ([], {}, Result.INVALID_PATH, "empty"),
        (corner(end=3.2), {"check_for_collisions": True}, Result.SMOOTHED_PATH_IN_COLLISION, "obstacle"),
        (corner(), {"max_smoothing_duration": Duration(nanosec=1)}, Result.TIMEOUT, "longer than 1e-09 s"),
        (corner(), {"frame": "odom"}, Result.UNKNOWN, "the costmap in map"),
    ],
)
def test_a_path_that_cannot_be_smoothed_is_aborted_with_the_reason(
    stage: Callable[[dict[str, Any]], Stage], poses: Any, goal: dict[str, Any], code: int, reason: str
) -> None:
    status, result = Bench(stage(PARAMETERS)).smooth(poses, **goal)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, code), result.error_msg
    assert reason in result.error_msg


def test_without_a_costmap_a_goal_times_out(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({"/smoother_server": {"costmap_timeout": 0.5}}), has_costmap=False)
    status, result = bench.smooth(corner())
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.TIMEOUT)
    assert "global_costmap/costmap_raw" in result.error_msg
