"""Which class stands behind a plugin name of Nav2's parameter files."""

from dataclasses import dataclass
from difflib import get_close_matches
from importlib import import_module
from importlib.metadata import entry_points
from typing import Any

from daidalos.navigation.errors import NavigationError

ENTRY_POINTS = "daidalos.navigation"
"""Group of entry points by which other packages add plugins: name in parameter files = module:class."""

_PACKAGE = "daidalos.navigation"
_CLASSES = {
    "nav2_costmap_2d::StaticLayer": "costmap.layers.static_layer:StaticLayer",
    "nav2_costmap_2d::ObstacleLayer": "costmap.layers.obstacle_layer:ObstacleLayer",
    "nav2_costmap_2d::InflationLayer": "costmap.layers.inflation_layer:InflationLayer",
    "nav2_navfn_planner::NavfnPlanner": "planners.navfn_planner:NavfnPlanner",
    "nav2_smoother::SimpleSmoother": "smoothers.simple_smoother:SimpleSmoother",
    "nav2_mppi_controller::MPPIController": "controllers.mppi_controller:MppiController",
    "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController": (
        "controllers.regulated_pure_pursuit_controller:RegulatedPurePursuitController"
    ),
    "nav2_rotation_shim_controller::RotationShimController": (
        "controllers.rotation_shim_controller:RotationShimController"
    ),
    "nav2_controller::SimpleGoalChecker": "controllers.plugins.simple_goal_checker:SimpleGoalChecker",
    "nav2_controller::StoppedGoalChecker": "controllers.plugins.stopped_goal_checker:StoppedGoalChecker",
    "nav2_controller::SimpleProgressChecker": ("controllers.plugins.simple_progress_checker:SimpleProgressChecker"),
    "nav2_controller::PoseProgressChecker": "controllers.plugins.pose_progress_checker:PoseProgressChecker",
    "nav2_behaviors::Spin": "behaviors.spin:Spin",
    "nav2_behaviors::BackUp": "behaviors.back_up:BackUp",
    "nav2_behaviors::DriveOnHeading": "behaviors.drive_on_heading:DriveOnHeading",
    "nav2_behaviors::Wait": "behaviors.wait:Wait",
    "mppi::critics::CostCritic": "controllers.mppi.critics.cost_critic:CostCritic",
    "mppi::critics::GoalAngleCritic": "controllers.mppi.critics.goal_angle_critic:GoalAngleCritic",
    "mppi::critics::GoalCritic": "controllers.mppi.critics.goal_critic:GoalCritic",
    "mppi::critics::PathAlignCritic": "controllers.mppi.critics.path_align_critic:PathAlignCritic",
    "mppi::critics::PathAngleCritic": "controllers.mppi.critics.path_angle_critic:PathAngleCritic",
    "mppi::critics::PathFollowCritic": "controllers.mppi.critics.path_follow_critic:PathFollowCritic",
    "mppi::critics::PreferForwardCritic": ("controllers.mppi.critics.prefer_forward_critic:PreferForwardCritic"),
    "mppi::critics::TwirlingCritic": "controllers.mppi.critics.twirling_critic:TwirlingCritic",
}


class UnknownPlugin(NavigationError):
    """There is no plugin of that name."""


@dataclass(frozen=True)
class Plugin:
    """A class, and the dataclass of its parameters.

    Attributes
    ----------
    made_by : type
        The class.
    parameters : type or None
        Frozen dataclass whose fields have the names of the parameter files; `None` where it has none.
    """

    made_by: Any
    parameters: Any | None


def find_plugin(name: str) -> Plugin:
    """Find a plugin.

    Parameters
    ----------
    name : str
        As in Nav2's parameter files, with `::` or, as in older ones, `/`; a critic of the MPPI controller
        without its namespace.

    Raises
    ------
    UnknownPlugin
        There is none; the message names the nearest.
    """
    full = name.replace("/", "::")
    place = _CLASSES.get(full) or _CLASSES.get(f"mppi::critics::{full}")
    if place is not None:
        module, class_name = place.split(":")
        made_by = getattr(import_module(f"{_PACKAGE}.{module}"), class_name)
    else:
        points = list(entry_points(group=ENTRY_POINTS, name=full))
        if not points:
            near = get_close_matches(full, _CLASSES, n=1, cutoff=0.3)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise UnknownPlugin(f"there is no plugin {name!r}{hint}")
        made_by = points[0].load()
    return Plugin(made_by, getattr(made_by, "Parameters", None))
