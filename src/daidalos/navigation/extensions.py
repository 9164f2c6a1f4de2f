"""Registry of navigation's extensions: planners, controllers, costmap layers, behaviors, tree nodes and others."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from daidalos.common.extensions import Kind, classes_in

if TYPE_CHECKING:
    from daidalos.navigation import contracts
    from daidalos.navigation.docking import contracts as docking
    from daidalos.navigation.routes import contracts as routes
    from daidalos.navigation.trees.node import TreeNode

_CONTRACTS = "daidalos.navigation.contracts"
_DOCKING = "daidalos.navigation.docking"
_ROUTES = "daidalos.navigation.routes"

COSTMAP_LAYERS: Kind[contracts.Layer] = Kind(
    "costmap_layer",
    "daidalos.costmap_layers",
    f"{_CONTRACTS}:Layer",
    "one source of a costmap's costs; named in `plugins` of a costmap",
    partial(classes_in, "daidalos.navigation.costmap.layers"),
)
PLANNERS: Kind[contracts.GlobalPlanner] = Kind(
    "planner",
    "daidalos.planners",
    f"{_CONTRACTS}:GlobalPlanner",
    "finds a path over a costmap; named in `planner_plugins` of the planner server",
    partial(classes_in, "daidalos.navigation.planners"),
)
SMOOTHERS: Kind[contracts.Smoother] = Kind(
    "smoother",
    "daidalos.smoothers",
    f"{_CONTRACTS}:Smoother",
    "makes a path smoother",
    partial(classes_in, "daidalos.navigation.smoothers"),
)
CONTROLLERS: Kind[contracts.Controller] = Kind(
    "navigation_controller",
    "daidalos.navigation_controllers",
    f"{_CONTRACTS}:Controller",
    "follows a path; named in `controller_plugins` of the controller server",
    partial(classes_in, "daidalos.navigation.controllers"),
)
CRITICS: Kind[contracts.Critic] = Kind(
    "critic",
    "daidalos.critics",
    f"{_CONTRACTS}:Critic",
    "gives trajectories of the MPPI controller a cost; named in its `critics`",
    partial(classes_in, "daidalos.navigation.controllers.mppi.critics"),
)
TRAJECTORY_VALIDATORS: Kind[contracts.TrajectoryValidator] = Kind(
    "trajectory_validator",
    "daidalos.trajectory_validators",
    f"{_CONTRACTS}:TrajectoryValidator",
    "checks the trajectory that the MPPI controller has chosen; named in its `TrajectoryValidator.plugin`",
    partial(classes_in, "daidalos.navigation.controllers.mppi.validators"),
)
TRAJECTORY_CRITICS: Kind[contracts.TrajectoryCritic] = Kind(
    "trajectory_critic",
    "daidalos.trajectory_critics",
    f"{_CONTRACTS}:TrajectoryCritic",
    "gives trajectories of the DWB controller a cost; named in its `critics`",
    partial(classes_in, "daidalos.navigation.controllers.dwb.critics"),
)
PATH_HANDLERS: Kind[contracts.PathHandler] = Kind(
    "path_handler",
    "daidalos.path_handlers",
    f"{_CONTRACTS}:PathHandler",
    "chooses how much of a path a controller sees; named in `path_handler_plugins` of the controller server",
    partial(classes_in, "daidalos.navigation.controllers.path_handlers"),
)
GOAL_CHECKERS: Kind[contracts.GoalChecker] = Kind(
    "goal_checker",
    "daidalos.goal_checkers",
    f"{_CONTRACTS}:GoalChecker",
    "decides whether a goal is reached; named in `goal_checker_plugins` of the controller server",
    partial(classes_in, "daidalos.navigation.controllers.goal_checkers"),
)
PROGRESS_CHECKERS: Kind[contracts.ProgressChecker] = Kind(
    "progress_checker",
    "daidalos.progress_checkers",
    f"{_CONTRACTS}:ProgressChecker",
    "decides whether a robot makes progress; named in `progress_checker_plugins` of the controller server",
    partial(classes_in, "daidalos.navigation.controllers.progress_checkers"),
)
BEHAVIORS: Kind[contracts.Behavior[object]] = Kind(
    "behavior",
    "daidalos.behaviors",
    f"{_CONTRACTS}:Behavior",
    "a motion that an action asks for; named in `behavior_plugins` of the behavior server",
    partial(classes_in, "daidalos.navigation.behaviors"),
)
WAYPOINT_TASKS: Kind[contracts.WaypointTask] = Kind(
    "waypoint_task",
    "daidalos.waypoint_tasks",
    f"{_CONTRACTS}:WaypointTask",
    "what a robot does at each waypoint; named in `waypoint_task_executor_plugin` of the waypoint follower",
    partial(classes_in, "daidalos.navigation.waypoint_tasks"),
)
GRAPH_FILE_LOADERS: Kind[routes.GraphFileLoader] = Kind(
    "graph_file_loader",
    "daidalos.graph_file_loaders",
    f"{_ROUTES}.contracts:GraphFileLoader",
    "reads a graph of routes; named in `graph_file_loader` of the route server",
    partial(classes_in, f"{_ROUTES}.loaders"),
)
EDGE_SCORERS: Kind[routes.EdgeScorer] = Kind(
    "edge_scorer",
    "daidalos.edge_scorers",
    f"{_ROUTES}.contracts:EdgeScorer",
    "gives edges of routes a cost; named in `edge_cost_functions` of the route server",
    partial(classes_in, f"{_ROUTES}.scorers"),
)
ROUTE_OPERATIONS: Kind[routes.RouteOperation] = Kind(
    "route_operation",
    "daidalos.route_operations",
    f"{_ROUTES}.contracts:RouteOperation",
    "is carried out on the way along a route; named in `operations` of the route server",
    partial(classes_in, f"{_ROUTES}.operations"),
)
DOCK_TYPES: Kind[docking.DockType] = Kind(
    "dock_type",
    "daidalos.dock_types",
    f"{_DOCKING}.contracts:DockType",
    "says where a robot waits before a dock, and when it is docked; named in `dock_plugins` of the docking server",
    partial(classes_in, f"{_DOCKING}.docks"),
)
TREE_NODES: Kind[TreeNode] = Kind(
    "tree_node",
    "daidalos.tree_nodes",
    "daidalos.navigation.trees.node:TreeNode",
    "a node of behaviour trees; named by an element of a tree's XML file",
    partial(
        classes_in,
        *(f"daidalos.navigation.trees.{folder}" for folder in ("action", "condition", "control", "decorator")),
    ),
)
KINDS = (
    COSTMAP_LAYERS,
    PLANNERS,
    SMOOTHERS,
    CONTROLLERS,
    CRITICS,
    TRAJECTORY_VALIDATORS,
    TRAJECTORY_CRITICS,
    PATH_HANDLERS,
    GOAL_CHECKERS,
    PROGRESS_CHECKERS,
    BEHAVIORS,
    WAYPOINT_TASKS,
    GRAPH_FILE_LOADERS,
    EDGE_SCORERS,
    ROUTE_OPERATIONS,
    DOCK_TYPES,
    TREE_NODES,
)
