"""Contracts of planners, controllers, costmap layers and the other extensions of navigation.

Every extension is one class, made with ``(parameters, context)``: its parameters, an instance of the frozen dataclass
in its class attribute `Parameters` whose fields have the names of Nav2's parameter files, and a `NavigationContext`.
Built-in classes give their names in Nav2's parameter files in `names`; those of other packages are named by entry
points, or by their class path. Poses are (x, y, yaw) in metres and radians, velocities (x, y, yaw) in m/s and rad/s in
the robot's frame; times are seconds. An extension that cannot do its work raises an error of
`daidalos.navigation.errors`.

The contract of behaviour-tree nodes is in `daidalos.navigation.trees.node`.
"""

from daidalos.navigation.contracts.behaviors import Behavior, BehaviorStep, WaypointTask
from daidalos.navigation.contracts.control import (
    Candidates,
    ControlInput,
    Controller,
    GoalChecker,
    PathHandler,
    ProgressChecker,
)
from daidalos.navigation.contracts.critics import Critic, Scene, TrajectoryCritic, TrajectoryScene, TrajectoryValidator
from daidalos.navigation.contracts.extension import NavigationContext, NavigationExtension
from daidalos.navigation.contracts.layers import Layer
from daidalos.navigation.contracts.planning import GlobalPlanner, Smoother
from daidalos.navigation.contracts.topics import Input, Output, SpeedLimit

__all__ = [
    "Behavior",
    "BehaviorStep",
    "Candidates",
    "ControlInput",
    "Controller",
    "Critic",
    "GlobalPlanner",
    "GoalChecker",
    "Input",
    "Layer",
    "NavigationContext",
    "NavigationExtension",
    "Output",
    "PathHandler",
    "ProgressChecker",
    "Scene",
    "Smoother",
    "SpeedLimit",
    "TrajectoryCritic",
    "TrajectoryScene",
    "TrajectoryValidator",
    "WaypointTask",
]
