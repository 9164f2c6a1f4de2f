"""Action nodes that select the plugin of later nodes."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port


def _ports(kind: str) -> dict[str, Port]:
    return {
        f"default_{kind}": Port(str),
        "topic_name": Port(str, f"{kind}_selector"),
        f"selected_{kind}": Port(str, output=True),
    }


class _Selector(Node):
    """Action node that outputs the last name that came on `topic_name`, or the default."""

    KIND: ClassVar[str]

    def update(self) -> Status:
        """Return success."""
        heard = self.services.latest(self.ports.get("topic_name"), "std_msgs/msg/String", latched=True)
        chosen = heard.data if heard is not None else ""
        self.ports.set(f"selected_{self.KIND}", chosen or self.ports.get(f"default_{self.KIND}"))
        return Status.SUCCESS


class PlannerSelector(_Selector):
    """Action node that outputs the last selected planner, or the default."""

    names = ("PlannerSelector",)
    KIND = "planner"
    PORTS: ClassVar[dict[str, Port]] = _ports("planner")


class ControllerSelector(_Selector):
    """Action node that outputs the last selected controller, or the default."""

    names = ("ControllerSelector",)
    KIND = "controller"
    PORTS: ClassVar[dict[str, Port]] = _ports("controller")


class SmootherSelector(_Selector):
    """Action node that outputs the last selected smoother, or the default."""

    names = ("SmootherSelector",)
    KIND = "smoother"
    PORTS: ClassVar[dict[str, Port]] = _ports("smoother")


class GoalCheckerSelector(_Selector):
    """Action node that outputs the last selected goal checker, or the default."""

    names = ("GoalCheckerSelector",)
    KIND = "goal_checker"
    PORTS: ClassVar[dict[str, Port]] = _ports("goal_checker")


class ProgressCheckerSelector(_Selector):
    """Action node that outputs the last selected progress checker, or the default."""

    names = ("ProgressCheckerSelector",)
    KIND = "progress_checker"
    PORTS: ClassVar[dict[str, Port]] = _ports("progress_checker")


class PathHandlerSelector(_Selector):
    """Action node that outputs the last selected path handler, or the default."""

    names = ("PathHandlerSelector",)
    KIND = "path_handler"
    PORTS: ClassVar[dict[str, Port]] = _ports("path_handler")
