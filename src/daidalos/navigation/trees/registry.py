"""Which class makes which node of a file."""

from importlib import import_module
from importlib.metadata import entry_points
from typing import Any

ENTRY_POINTS = "daidalos.tree_nodes"
"""Group of entry points by which other packages add nodes: name in files = module:class."""

_PACKAGE = "daidalos.navigation.trees"
_CLASSES = {
    "BackUp": "action.back_up",
    "ClearCostmapAroundRobot": "action.clear_costmap",
    "ClearCostmapExceptRegion": "action.clear_costmap",
    "ClearEntireCostmap": "action.clear_costmap",
    "ComputePathToPose": "action.compute_path_to_pose",
    "ControllerSelector": "action.selector",
    "DriveOnHeading": "action.drive_on_heading",
    "FollowPath": "action.follow_path",
    "PlannerSelector": "action.selector",
    "SmoothPath": "action.smooth_path",
    "Spin": "action.spin",
    "Wait": "action.wait",
    "GoalUpdated": "condition.goal_updated",
    "WouldAControllerRecoveryHelp": "condition.would_recovery_help",
    "WouldAPlannerRecoveryHelp": "condition.would_recovery_help",
    "Fallback": "control.fallback",
    "PipelineSequence": "control.pipeline_sequence",
    "ReactiveFallback": "control.fallback",
    "ReactiveSequence": "control.sequence",
    "RecoveryNode": "control.recovery_node",
    "RoundRobin": "control.round_robin",
    "Sequence": "control.sequence",
    "ForceFailure": "decorator.force",
    "ForceSuccess": "decorator.force",
    "Inverter": "decorator.inverter",
    "RateController": "decorator.rate_controller",
}


def node_class(identifier: str) -> Any | None:
    """Class of a node by its name in files; `None` where there is none."""
    module = _CLASSES.get(identifier)
    if module is not None:
        return getattr(import_module(f"{_PACKAGE}.{module}"), identifier)
    for point in entry_points(group=ENTRY_POINTS, name=identifier):
        return point.load()
    return None


def known_nodes() -> list[str]:
    """Names of all nodes, sorted."""
    return sorted({*_CLASSES, *(point.name for point in entry_points(group=ENTRY_POINTS))})
