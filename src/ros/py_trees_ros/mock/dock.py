"""Action server that docks and undocks."""

from __future__ import annotations

from typing import Any

from py_trees_ros_interfaces.action import Dock as DockAction

from py_trees_ros.mock.actions import GenericServer


class Dock(GenericServer):
    """Action server ``dock``.

    Parameters
    ----------
    duration
        How long it takes [s].
    """

    def __init__(self, duration: float = 2.0) -> None:
        self.title = ""
        super().__init__(
            "docking_controller",
            "dock",
            DockAction,
            generate_feedback_message=lambda: DockAction.Feedback(percentage_completed=self.percent_completed),
            goal_received_callback=self._receive,
            duration=duration,
        )

    def _receive(self, goal: Any) -> None:
        self.title = "Dock" if goal.dock else "UnDock"
