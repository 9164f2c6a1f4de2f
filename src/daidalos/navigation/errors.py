"""What can go wrong while navigating: the base of every error of this layer."""

from daidalos.common.errors import UserError


class NavigationError(UserError):
    """Something in navigation failed; the message is meant for the person who sent the robot.

    Attributes
    ----------
    code : str
        Name of the error code in the result of the Nav2 action that reports it (`GOAL_OCCUPIED`,
        `FAILED_TO_MAKE_PROGRESS`, ...).
    """

    code: str = "UNKNOWN"


class PlannerError(NavigationError):
    """There is no plan; the message says why."""


class StartOutsideMap(PlannerError):
    """The robot is not on the map."""

    code = "START_OUTSIDE_MAP"


class GoalOutsideMap(PlannerError):
    """The goal is not on the map."""

    code = "GOAL_OUTSIDE_MAP"


class StartOccupied(PlannerError):
    """The robot's centre is on an obstacle and nothing free is near."""

    code = "START_OCCUPIED"


class GoalOccupied(PlannerError):
    """The robot can not stand at the goal."""

    code = "GOAL_OCCUPIED"


class NoPath(PlannerError):
    """Start and goal are free, but nothing connects them."""

    code = "NO_VALID_PATH"


class ControllerError(NavigationError):
    """The robot can not be driven along the path; the message says why."""


class InvalidPath(ControllerError):
    """The path is empty or does not pass the robot."""

    code = "INVALID_PATH"


class NoValidControl(ControllerError):
    """Every motion that the controller can think of ends in contact."""

    code = "NO_VALID_CONTROL"


class FailedToMakeProgress(ControllerError):
    """The robot did not move as far as it must in the time it is given."""

    code = "FAILED_TO_MAKE_PROGRESS"


class PatienceExceeded(ControllerError):
    """The controller failed for longer than it may."""

    code = "PATIENCE_EXCEEDED"


class BehaviorError(NavigationError):
    """A behaviour ended before it was done; the message says why."""


class CollisionAhead(BehaviorError):
    """The robot would touch something."""

    code = "COLLISION_AHEAD"


class TimedOut(BehaviorError):
    """The time allowance is used up."""

    code = "TIMEOUT"


class InvalidInput(BehaviorError):
    """The command makes no sense."""

    code = "INVALID_INPUT"
