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
