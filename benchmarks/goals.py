"""What the figures should reach, and what the programs that people know reach."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Goal:
    """A limit: at most, or at least, so much; `theirs` is the figure of the software that people know."""

    limit: float
    at_least: bool = False
    theirs: str = ""

    def is_met(self, value: float) -> bool:
        return value >= self.limit if self.at_least else value <= self.limit

    def __str__(self) -> str:
        return f"{'>=' if self.at_least else '<='} {self.limit:g}"


def goal_of(figure: str) -> Goal | None:
    """Return the goal of a figure, None where there is none."""
    return GOALS.get(figure)


GOALS = {
    "demo.real_time_factor": Goal(0.995, at_least=True),
    "demo.moving_robot_s": Goal(10.0),
    "demo.end_s": Goal(5.0),
    "demo.goals_reached": Goal(3, at_least=True),
    "demo.contacts": Goal(0),
    "command.import_and_node_s": Goal(0.3),
    "command.ros2_help_s": Goal(0.15),
    "command.ros2_topic_list_s": Goal(0.5),
    "command.ros2_topic_list_with_daemon_s": Goal(0.25),
    "mapping.intel_translation_m": Goal(0.37, theirs="0.023 Cartographer"),
    "simulation.real_time_factor_with_50_boxes": Goal(5.0, at_least=True),
    "simulation.scan_820_rays_ms": Goal(0.5),
    "simulation.first_scan_s": Goal(3.0),
    "simulation.straight_10_m_error_mm": Goal(5.0),
    "simulation.ten_turns_error_percent": Goal(0.1),
}
