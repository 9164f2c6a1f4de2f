"""`smoother_server`: smooths paths over the global costmap."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

from tf2_ros import Buffer, TransformListener

from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import NavigationContext, Smoother
from daidalos.navigation.costmap.footprint import Footprint, FootprintCollisionChecker
from daidalos.navigation.errors import InvalidPath, NavigationError, PathInCollision, SmootherError
from daidalos.navigation.extensions import SMOOTHERS
from daidalos.nodes.action_results import TransformFailed
from daidalos.nodes.conversions import path_array, path_message
from daidalos.nodes.cycles import wait_until
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.nav2_costmap_2d._costmap_listener import CostmapListener
from daidalos.nodes.navigation_extensions import ExtensionMaker
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.warming import warm_up_in_background
from daidalos.samples.fields import seconds, time_message

_POLL_HZ = 20.0
_DEFAULT_PLUGINS = {"simple_smoother": "nav2_smoother::SimpleSmoother"}
_WITHOUT_EFFECT = {
    "transform_tolerance": "the footprint is transformed at the time of its message",
    "action_server_result_timeout": "results are kept as long as the server runs",
    "bond_heartbeat_period": "there are no bonds; the lifecycle manager asks for states",
}
"""Parameters of some of Nav2's releases that do nothing here, with the reason."""


class UnknownSmoother(NavigationError):
    """There is no smoother of that name."""

    code = "INVALID_SMOOTHER"


class SmootherTimedOut(NavigationError):
    """The costmap was waited for in vain, or smoothing took longer than allowed."""

    code = "TIMEOUT"


@dataclass(frozen=True)
class SmootherServerParameters(Parameters):
    """Parameters of the node, by their Nav2 names; `costmap_timeout` is ours."""

    smoother_plugins: tuple[str, ...] = parameter(
        tuple(_DEFAULT_PLUGINS), "Names of the smoothers.", not_empty=True, unique=True, read_only=True
    )
    costmap_topic: str = parameter(
        "global_costmap/costmap_raw", "Topic of the costmap.", not_empty=True, read_only=True
    )
    footprint_topic: str = parameter(
        "global_costmap/published_footprint", "Topic of the robot's outline.", not_empty=True, read_only=True
    )
    robot_base_frame: str = parameter("base_link", "Frame of the robot's base.", not_empty=True, read_only=True)
    costmap_timeout: float = parameter(5.0, "How long a goal waits for the first costmap.", unit="s", minimum=0.0)


class SmootherServer(ManagedNode):
    """Server of ``smooth_path``."""

    def __init__(self, node_name: str = "smoother_server", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._settings = declare(self, SmootherServerParameters, reconfigure=self._reconfigure)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._smoothers: dict[str, Smoother] = {}

    def _reconfigure(self, parameters: SmootherServerParameters) -> None:
        """Use another time limit from the next goal on."""
        self._settings = parameters

    def configure(self) -> None:
        """Make the smoothers and serve."""
        from nav2_msgs.action import SmoothPath
        from nav_msgs.msg import Path

        p = self._settings
        declare_without_effect(self, _WITHOUT_EFFECT)
        self._surroundings = CostmapListener(
            self, self._buffer, p.robot_base_frame, p.costmap_topic, p.footprint_topic, Footprint.circle(0.1)
        )
        maker = ExtensionMaker(self, NavigationContext(base_frame=p.robot_base_frame))
        self._smoothers = {
            name: maker.make(SMOOTHERS, name, _DEFAULT_PLUGINS.get(name, "")) for name in p.smoother_plugins
        }
        kinds = map(type, self._smoothers.values())
        self._compiled = warm_up_in_background("daidalos.navigation", self.get_logger(), kinds)
        self._publisher = self.create_publisher(Path, "plan_smoothed", 1)
        self.serve_action(SmoothPath, "smooth_path", self._smooth_path)

    async def _smooth_path(self, goal_handle: Any) -> Any:
        from nav2_msgs.action import SmoothPath

        result = SmoothPath.Result()
        request = goal_handle.request
        smoother, path = self._smoother(request.smoother_id), self._path(request.path)
        await self._compiled
        if not await wait_until(lambda: self._is_ready(goal_handle), self, _POLL_HZ, self._settings.costmap_timeout):
            raise SmootherTimedOut(f"there is no costmap on '{self._settings.costmap_topic}'")
        if not goal_handle.is_active or goal_handle.is_cancel_requested:
            if goal_handle.is_active:
                goal_handle.canceled()
            return result
        begun = time.monotonic_ns()
        smoothed = self._smooth(smoother, path, request)
        took_ns = time.monotonic_ns() - begun
        took = time_message(took_ns)
        result.smoothing_duration.sec, result.smoothing_duration.nanosec = took.sec, took.nanosec
        limit = seconds(request.max_smoothing_duration)
        if 0.0 < limit < 1e-9 * took_ns:
            raise SmootherTimedOut(f"smoothing took {1e-9 * took_ns:.3g} s, longer than {limit:g} s")
        result.path = path_message(smoothed, request.path.header.frame_id, self.get_clock().now().to_msg())
        result.was_completed = True
        self._publisher.publish(result.path)
        goal_handle.succeed()
        return result

    def _is_ready(self, goal_handle: Any) -> bool:
        is_over = goal_handle.is_cancel_requested or not goal_handle.is_active
        return is_over or self._surroundings.costmap is not None

    def _smoother(self, name: str) -> Smoother:
        """Return the smoother of a name; the first one where it is empty."""
        name = name or next(iter(self._smoothers))
        if name not in self._smoothers:
            raise UnknownSmoother(f"there is no smoother '{name}'; there are: {', '.join(self._smoothers)}")
        return self._smoothers[name]

    def _path(self, message: Any) -> Any:
        path = path_array(message)
        if not path.shape[0]:
            raise InvalidPath("the path is empty")
        return path

    def _smooth(self, smoother: Smoother, path: Any, request: Any) -> Any:
        """Return the smoothed path, checked for collisions if that is asked for."""
        costmap, frame = self._surroundings.costmap, request.path.header.frame_id
        assert costmap is not None
        if frame and frame != self._surroundings.frame:
            raise TransformFailed(f"the path is in {frame}, the costmap in {self._surroundings.frame}")
        smoothed = smoother.smooth(path, costmap)
        if smoothed.shape[0] == 0:
            raise SmootherError("the smoother returned an empty path")
        if request.check_for_collisions:
            checker = FootprintCollisionChecker(costmap, self._surroundings.footprint)
            for pose in smoothed:
                if checker.in_collision(pose):
                    raise PathInCollision(f"the smoothed path touches an obstacle at ({pose[0]:.2f}, {pose[1]:.2f})")
        return smoothed
