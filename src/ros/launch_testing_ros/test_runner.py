"""Runs of launched systems with their tests, in which the launch has a ROS node."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from launch.actions import OpaqueFunction
from launch_testing.test_runner import LaunchTestRunner as _LaunchTestRunner

if TYPE_CHECKING:
    from launch import Action, LaunchContext


class LaunchTestRunner(_LaunchTestRunner):
    """Runner that starts the launch's own ROS node before the launch.

    Tests have it as ``launch_service.context.locals.launch_ros_node``, spun meanwhile.
    """

    def generate_preamble(self) -> list[Action]:
        """Return the action that starts the node."""
        return [*super().generate_preamble(), OpaqueFunction(function=_start_node)]


def _start_node(context: LaunchContext) -> None:
    from launch_ros.ros_adapters import get_ros_node

    node: Any = get_ros_node(context)
    context.extend_globals({"launch_ros_node": node})
