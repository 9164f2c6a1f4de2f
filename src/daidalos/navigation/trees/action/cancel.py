"""Action nodes that cancel all goals of an action, whoever sent them."""

from collections.abc import Mapping
from typing import Any, ClassVar

from daidalos.navigation.trees.action_node import SERVER, ActionNode
from daidalos.navigation.trees.node import Port


class CancelGoals(ActionNode):
    """Action node that cancels the goals of an action; it succeeds once the server has answered."""

    INTERFACE = "action_msgs/srv/CancelGoal"
    ACTION: ClassVar[str]
    PORTS: ClassVar[dict[str, Port]] = SERVER

    @classmethod
    def service(cls, inputs: Mapping[str, Any]) -> str:
        """Implement `ActionNode.service`."""
        return f"{inputs.get('server_name') or cls.ACTION}/_action/cancel_goal"

    @classmethod
    def goal(cls, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """Return an empty request, which means all goals."""
        return {}


class CancelControl(CancelGoals):
    """Action node that cancels the following of paths."""

    names = ("CancelControl",)
    ACTION = "follow_path"


class CancelSpin(CancelGoals):
    """Action node that cancels rotations in place."""

    names = ("CancelSpin",)
    ACTION = "spin"


class CancelBackUp(CancelGoals):
    """Action node that cancels driving backwards."""

    names = ("CancelBackUp",)
    ACTION = "backup"


class CancelDriveOnHeading(CancelGoals):
    """Action node that cancels driving straight."""

    names = ("CancelDriveOnHeading",)
    ACTION = "drive_on_heading"


class CancelAssistedTeleop(CancelGoals):
    """Action node that cancels assisted teleoperation."""

    names = ("CancelAssistedTeleop",)
    ACTION = "assisted_teleop"


class CancelWait(CancelGoals):
    """Action node that cancels waiting."""

    names = ("CancelWait",)
    ACTION = "wait"
