"""Example of diagnostics: functions, methods, classes, combinations and a monitored topic."""

from __future__ import annotations

import rclpy
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Bool

import diagnostic_updater
from diagnostic_updater import DiagnosticStatusWrapper

time_to_launch = 0.0


def dummy_diagnostic(stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
    """Fill in a status: a summary, and any number of values. It must be returned."""
    if time_to_launch < 10:
        stat.summary(DiagnosticStatus.ERROR, f"Buckle your seat belt. Launch in {time_to_launch:f} seconds!")
    else:
        stat.summary(DiagnosticStatus.OK, "Launch is in a long time. Have a soda.")
    stat.add("Diagnostic Name", "dummy")
    stat.add("Time to Launch", time_to_launch)
    return stat


class DummyClass:
    """Class with a reporting method."""

    def produce_diagnostics(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill in a status."""
        stat.summary(DiagnosticStatus.WARN, "This is a silly updater.")
        stat.add("Silliness of this updater", 1000)
        return stat


class DummyTask(diagnostic_updater.DiagnosticTask):
    """A task of its own."""

    def __init__(self) -> None:
        super().__init__("Updater Derived from DiagnosticTask")

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill in a status."""
        stat.summary(DiagnosticStatus.WARN, "This is another silly updater.")
        stat.add("Silliness of this updater", 2000)
        return stat


def check_lower_bound(stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
    """Report whether there is enough time."""
    enough = time_to_launch > 5
    stat.summary(*((DiagnosticStatus.OK, "Lower-bound OK") if enough else (DiagnosticStatus.ERROR, "Too low")))
    stat.add("Low-Side Margin", time_to_launch - 5)
    return stat


def check_upper_bound(stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
    """Report whether there is too much time."""
    enough = time_to_launch < 10
    stat.summary(*((DiagnosticStatus.OK, "Upper-bound OK") if enough else (DiagnosticStatus.WARN, "Too high")))
    stat.add("Top-Side Margin", 10 - time_to_launch)
    return stat


def main() -> None:
    """Report until Ctrl-C."""
    rclpy.init()
    node = rclpy.create_node("diagnostic_updater_example")
    updater = diagnostic_updater.Updater(node)
    updater.setHardwareID("Device-27-46")

    updater.add("Function updater", dummy_diagnostic)
    updater.add("Method updater", DummyClass().produce_diagnostics)
    updater.add(DummyTask())

    bounds = diagnostic_updater.CompositeDiagnosticTask("Bound check")
    bounds.addTask(diagnostic_updater.FunctionDiagnosticTask("Lower-bound check", check_lower_bound))
    bounds.addTask(diagnostic_updater.FunctionDiagnosticTask("Upper-bound check", check_upper_bound))
    updater.add(bounds)
    updater.broadcast(DiagnosticStatus.OK, "Doing important initialization stuff.")

    publisher = node.create_publisher(Bool, "topic1", 10)
    allowed = diagnostic_updater.FrequencyStatusParam({"min": 0.5, "max": 20.0}, 0.1, 10)
    watched = diagnostic_updater.HeaderlessTopicDiagnostic("topic1", updater, allowed)

    def publish() -> None:
        publisher.publish(Bool())
        watched.tick()

    node.create_timer(0.1, publish)
    updater.force_update()
    updater.removeByName("Bound check")
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        node.destroy_node()


if __name__ == "__main__":
    main()
