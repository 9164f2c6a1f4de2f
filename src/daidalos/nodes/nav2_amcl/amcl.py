"""`amcl`: localizes a robot in a map, as a managed node of Nav2."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn
from rclpy.parameter import Parameter

from daidalos.common.arrays import Array
from daidalos.common.documents import DocumentError, read_yaml
from daidalos.common.errors import UserError
from daidalos.nodes.conversions import pose2_of
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.nav2_amcl._localizer import Localizer
from daidalos.nodes.nav2_amcl._parameters import WITHOUT_EFFECT, AmclParameters
from daidalos.nodes.parameters import declare, declare_without_effect
from daidalos.nodes.runner import run


class AmclNode(ManagedNode):
    """Node that publishes the pose, the particles and the transform from the map to the odometry.

    Its parameters are those of `AmclParameters`.
    """

    def __init__(self, node_name: str = "amcl", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._localizer: Localizer | None = None
        self._last_pose: Any = None
        self._settings = declare(self, AmclParameters, reconfigure=self._reconfigure)
        declare_without_effect(self, WITHOUT_EFFECT)

    def _reconfigure(self, parameters: AmclParameters) -> None:
        self._settings = parameters
        if self._localizer is not None:
            self._localizer.reconfigure(parameters)

    def configure(self) -> None:
        """Create the filter, its topics and its services."""
        from nav2_msgs.srv import SetInitialPose
        from std_srvs.srv import Empty

        self._localizer = Localizer(self, self._settings, lambda: self.is_active)
        if self._last_pose is not None and not self._settings.always_reset_initial_pose:
            self._localizer.take_initial_pose(self._last_pose)
        self.create_service(Empty, "reinitialize_global_localization", self._on_global_localization)
        self.create_service(Empty, "request_nomotion_update", self._on_nomotion_update)
        self.create_service(SetInitialPose, "set_initial_pose", self._on_set_initial_pose)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Take the initial pose of the parameters or of the file, and begin to use scans."""
        assert self._localizer is not None
        p = self._settings
        if p.set_initial_pose:
            initial = p.initial_pose
            self._localizer.take_saved_pose(np.array([initial.x, initial.y, initial.yaw]))
        elif p.initialize_at_saved_pose:
            try:
                self._localizer.take_saved_pose(_read_pose(self._saved_pose_file))
            except UserError as error:
                self.get_logger().warning(f"there is no initial pose: {error}")
        if p.initialize_at_saved_pose and p.save_pose_rate > 0.0:
            self._save_timer = self.create_timer(1.0 / p.save_pose_rate, self._save_pose)
        self._localizer.start()
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop using scans."""
        if self._settings.initialize_at_saved_pose and self._settings.save_pose_rate > 0.0:
            self.destroy_timer(self._save_timer)
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Destroy what was created; the last pose is kept for the next configuration."""
        if self._localizer is not None:
            self._localizer.destroy()
            self._last_pose = self._localizer.last_pose
            self._localizer = None
            if self._settings.set_initial_pose and self._last_pose is not None:
                self._keep_as_initial_pose(pose2_of(self._last_pose.pose.pose))
        return super().on_cleanup(state)

    def _keep_as_initial_pose(self, pose: Array) -> None:
        values = zip(("x", "y", "yaw"), pose.tolist(), strict=True)
        self.set_parameters([Parameter(f"initial_pose.{name}", value=value) for name, value in values])

    # Services.

    def _on_global_localization(self, request: Any, response: Any) -> Any:
        if self._localizer is not None:
            self._localizer.take_global_localization()
        return response

    def _on_nomotion_update(self, request: Any, response: Any) -> Any:
        if self._localizer is not None:
            self._localizer.request_update()
        return response

    def _on_set_initial_pose(self, request: Any, response: Any) -> Any:
        if self._localizer is not None:
            self._localizer.take_initial_pose(request.pose)
        return response

    # The saved pose.

    @property
    def _saved_pose_file(self) -> Path:
        given = self._settings.saved_pose_filepath
        return Path(given) if given else Path(os.environ.get("ROS_HOME", "~/.ros")).expanduser() / "amcl_saved_pose"

    def _save_pose(self) -> None:
        if self._localizer is not None and self._localizer.last_pose is not None:
            try:
                _write_pose(self._saved_pose_file, self._localizer.last_pose)
            except OSError as error:
                self.get_logger().warning(
                    f"cannot save the pose: {self._saved_pose_file}: {error.strerror}", throttle_duration_sec=10.0
                )


def _write_pose(path: Path, message: Any) -> None:
    """Write a pose as Nav2 does; the file always is whole."""
    x, y, yaw = pose2_of(message.pose.pose).tolist()
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.tmp")
    stamp = f"{message.header.stamp.sec}.{message.header.stamp.nanosec:09d}"
    lines = (
        f"timestamp: {stamp}",
        f"frame_id: {message.header.frame_id}",
        f"x: {x}",
        f"y: {y}",
        "z: 0.0",
        f"yaw: {yaw}",
    )
    part.write_text("\n".join(lines) + "\n", encoding="utf-8")
    part.replace(path)


def _read_pose(path: Path) -> Array:
    """Return the pose (x, y, yaw) of a file.

    Raises
    ------
    UserError
        When there is none.
    """
    try:
        content = read_yaml(path)
        pose = np.array([float(content[name]) for name in ("x", "y", "yaw")])
    except OSError as error:
        raise UserError(f"{path}: {error.strerror}") from error
    except DocumentError as error:
        raise UserError(f"{path}: {error}") from error
    except (TypeError, KeyError, OverflowError, ValueError) as error:
        raise UserError(f"{path}: expected numbers x, y and yaw") from error
    if not np.isfinite(pose).all():
        raise UserError(f"{path}: expected finite numbers x, y and yaw")
    return pose


def main() -> int:
    """Run the node."""
    return run(AmclNode)
