"""Diagnostics of controllers and hardware on ``/diagnostics`` under the names of ros2_control."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import Updater

from daidalos.control.component import ACTIVE, FINALIZED
from daidalos.control.manager import ControllerManager

Report = Callable[[Any], Any]


def start_diagnostics(node: Any, manager: ControllerManager, lock: Any) -> Updater:
    """Publish reports from now on, every ``diagnostic_updater.period``.

    Parameters
    ----------
    node : Node
    manager : ControllerManager
    lock : context manager
        Held while the manager is looked at.
    """
    updater = Updater(node)
    updater.setHardwareID("ros2_control")
    updater.add("Controllers Activity", _report_of(manager, lock, _report_controllers))
    updater.add("Hardware Components Activity", _report_of(manager, lock, _report_hardware))
    updater.add("Controller Manager Activity", _report_of(manager, lock, _report_manager))
    return updater


def _report_of(manager: ControllerManager, lock: Any, report: Callable[[Any, ControllerManager], None]) -> Report:
    def work(status: Any) -> Any:
        with lock:
            report(status, manager)
        return status

    return work


def _report_controllers(status: Any, manager: ControllerManager) -> None:
    states = {name: loaded.state for name, loaded in manager.controllers.items()}
    _report_states(status, "controllers", states)


def _report_hardware(status: Any, manager: ControllerManager) -> None:
    states = {name: component.state for name, component in manager.components.items()}
    _report_states(status, "hardware components", states)


def _report_manager(status: Any, manager: ControllerManager) -> None:
    status.summary(DiagnosticStatus.OK, "Controller manager is running")
    status.add("update_rate", str(round(manager.update_rate)))


def _report_states(status: Any, what: str, states: dict[str, str]) -> None:
    for name, state in states.items():
        status.add(name, state)
    if FINALIZED in states.values():
        status.summary(DiagnosticStatus.ERROR, f"Some {what} are finalized")
    elif all(state == ACTIVE for state in states.values()):
        status.summary(DiagnosticStatus.OK, f"All {what} are active" if states else f"There are no {what}")
    else:
        status.summary(DiagnosticStatus.WARN, f"Not all {what} are active")
