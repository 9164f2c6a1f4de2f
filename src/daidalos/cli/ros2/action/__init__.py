"""`ros2 action`."""

from typing import ClassVar

from daidalos.cli.ros2.verbs import VerbCommand


class ActionCommand(VerbCommand):
    """Various action related sub-commands."""

    group = "ros2action.verb"
    verbs: ClassVar = {
        "find": "Find actions from type",
        "info": "Print information about an action",
        "list": "Output a list of action names",
        "send_goal": "Send an action goal",
        "type": "Print a action's type",
    }
