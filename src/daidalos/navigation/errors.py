"""Base of navigation's errors."""

from daidalos.common.errors import UserError


class NavigationError(UserError):
    """Error of navigation, with a message for the user.

    Attributes
    ----------
    code : str
        Name of the error code in the result of the Nav2 action that reports it (`GOAL_OCCUPIED`,
        `FAILED_TO_MAKE_PROGRESS`, ...).
    """

    code: str = "UNKNOWN"


class PlannerError(NavigationError):
    """Failure to plan; the message gives the reason."""


class StartOutsideMap(PlannerError):
    """Start outside of the map."""

    code = "START_OUTSIDE_MAP"


class GoalOutsideMap(PlannerError):
    """Goal outside of the map."""

    code = "GOAL_OUTSIDE_MAP"


class StartOccupied(PlannerError):
    """Start on an obstacle without free cells nearby."""

    code = "START_OCCUPIED"


class GoalOccupied(PlannerError):
    """Goal on an obstacle."""

    code = "GOAL_OCCUPIED"


class NoPath(PlannerError):
    """Free start and goal without a connection."""

    code = "NO_VALID_PATH"


class PlanningTimedOut(PlannerError):
    """Search for a path that took longer than allowed."""

    code = "TIMEOUT"


class PlanningCancelled(PlannerError):
    """Search for a path that is no longer wanted."""


class ControllerError(NavigationError):
    """Failure to follow the path; the message gives the reason."""


class InvalidPath(ControllerError):
    """Path that is empty or far from the robot."""

    code = "INVALID_PATH"


class NoValidControl(ControllerError):
    """All candidate motions collide."""

    code = "NO_VALID_CONTROL"


class FailedToMakeProgress(ControllerError):
    """The robot did not move far enough within its time."""

    code = "FAILED_TO_MAKE_PROGRESS"


class PatienceExceeded(ControllerError):
    """The controller failed for longer than its failure tolerance."""

    code = "PATIENCE_EXCEEDED"


class SmootherError(NavigationError):
    """Failure to smooth a path; the message gives the reason."""

    code = "FAILED_TO_SMOOTH_PATH"


class PathInCollision(SmootherError):
    """Smoothed path that touches an obstacle."""

    code = "SMOOTHED_PATH_IN_COLLISION"


class BehaviorError(NavigationError):
    """Failed behavior; the message gives the reason."""


class CollisionAhead(BehaviorError):
    """Imminent collision."""

    code = "COLLISION_AHEAD"


class TimedOut(BehaviorError):
    """Exceeded time allowance."""

    code = "TIMEOUT"


class InvalidInput(BehaviorError):
    """Invalid command."""

    code = "INVALID_INPUT"


class TaskFailed(NavigationError):
    """Failure of the task at a waypoint; the message gives the reason."""

    code = "TASK_EXECUTOR_FAILED"


class RouteError(NavigationError):
    """Failure to find or track a route; the message gives the reason."""


class NoValidGraph(RouteError):
    """Graph that is missing or cannot be used."""

    code = "NO_VALID_GRAPH"


class IndeterminateNodes(RouteError):
    """Start or goal without a node of the graph."""

    code = "INDETERMINANT_NODES_ON_GRAPH"


class RouteTimedOut(RouteError):
    """Search that took longer than allowed."""

    code = "TIMEOUT"


class NoValidRoute(RouteError):
    """Start and goal without an open connection."""

    code = "NO_VALID_ROUTE"


class OperationFailed(RouteError):
    """Operation on the way that failed."""

    code = "OPERATION_FAILED"


class InvalidScorerUse(RouteError):
    """Scorer that lacks what it needs in the request."""

    code = "INVALID_EDGE_SCORER_USE"


class DockingError(NavigationError):
    """Failure to dock or undock; the message gives the reason."""


class DockNotInDatabase(DockingError):
    """Dock that the server does not know."""

    code = "DOCK_NOT_IN_DB"


class DockNotValid(DockingError):
    """Dock of an unknown type, or without a usable pose."""

    code = "DOCK_NOT_VALID"


class FailedToStage(DockingError):
    """Pose in front of the dock that was not reached."""

    code = "FAILED_TO_STAGE"


class FailedToDetectDock(DockingError):
    """Dock that is not seen."""

    code = "FAILED_TO_DETECT_DOCK"


class FailedToControl(DockingError):
    """Dock or staging pose that was not reached in time, or an obstacle on the way."""

    code = "FAILED_TO_CONTROL"


class FailedToCharge(DockingError):
    """Dock that does not charge."""

    code = "FAILED_TO_CHARGE"


class FailedToDetectObject(NavigationError):
    """Object to follow that is not seen."""

    code = "FAILED_TO_DETECT_OBJECT"
