"""Tasks that find out how something is, and the updater that publishes what they find."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from ._diagnostic_status_wrapper import DiagnosticStatusWrapper

if TYPE_CHECKING:
    from rclpy.node import Node

Function = Callable[[DiagnosticStatusWrapper], DiagnosticStatusWrapper]


class DiagnosticTask:
    """Base of tasks: a name, and a method that fills in a status."""

    def __init__(self, name: str) -> None:
        self.name = name

    def getName(self) -> str:
        """Return the task's name."""
        return self.name

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill in a status and return it."""
        return stat


class FunctionDiagnosticTask(DiagnosticTask):
    """A task whose work a function does."""

    def __init__(self, name: str, fn: Function) -> None:
        super().__init__(name)
        self.fn = fn

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Call the function to fill in a status."""
        return self.fn(stat)


class CompositeDiagnosticTask(DiagnosticTask):
    """Several tasks that fill in one status: their values in a row, their summaries merged."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.tasks: list[DiagnosticTask] = []

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Run all tasks on a status; each of them finds the summary as it was at first."""
        original, combined = DiagnosticStatusWrapper(), DiagnosticStatusWrapper()
        original.summary(stat)
        for task in self.tasks:
            stat.summary(original)
            stat = task.run(stat)
            combined.mergeSummary(stat)
        stat.summary(combined)
        return stat

    def addTask(self, t: DiagnosticTask) -> None:
        """Add a task."""
        self.tasks.append(t)


class DiagnosticTaskVector:
    """A list of tasks, each of which fills in a status of its own."""

    class DiagnosticTaskInternal:
        """A task as the list keeps it."""

        def __init__(self, name: str, fn: Function) -> None:
            self.name = name
            self.fn = fn

        def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
            """Fill in a status, its name too, and return it."""
            stat.name = self.name
            return self.fn(stat)

    def __init__(self) -> None:
        self.tasks: list[DiagnosticTaskVector.DiagnosticTaskInternal] = []
        self.lock = threading.Lock()

    def addedTaskCallback(self, task: DiagnosticTaskVector.DiagnosticTaskInternal) -> None:
        """React to a task that was added; subclasses override this."""

    def add(self, *args: Any) -> None:
        """Add a task: ``add(task)``, or ``add(name, function)``.

        Raises
        ------
        TypeError
            For other arguments.
        """
        if len(args) == 1:
            args = (args[0].getName(), args[0].run)
        if len(args) != 2:
            raise TypeError(f"add() takes a task, or a name and a function, not {len(args)} arguments")
        task = DiagnosticTaskVector.DiagnosticTaskInternal(*args)
        with self.lock:
            self.tasks.append(task)
        self.addedTaskCallback(task)

    def removeByName(self, name: str) -> bool:
        """Remove the first task of that name; return whether there was one."""
        with self.lock:
            for task in self.tasks:
                if task.name == name:
                    self.tasks.remove(task)
                    return True
        return False


class Updater(DiagnosticTaskVector):
    """Updater that runs tasks periodically and publishes the results on ``/diagnostics``.

    The node gets the parameters ``diagnostic_updater.period``, in seconds, and ``diagnostic_updater.use_fqn``:
    whether names begin with the node's full name.

    Parameters
    ----------
    node
        The node that reports.
    period
        In seconds; the node's parameter outweighs it.
    """

    def __init__(self, node: Node, period: float = 1.0) -> None:
        super().__init__()
        self.node = node
        self.verbose = False
        self.hwid = ""
        self.warn_nohwid_done = False
        self.period_parameter = "diagnostic_updater.period"
        self.use_fqn_parameter = "diagnostic_updater.use_fqn"
        self.__period = float(self._declare(self.period_parameter, float(period)))
        self._prefix = (
            node.get_fully_qualified_name() if self._declare(self.use_fqn_parameter, False) else node.get_name()
        )
        self.publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 1)
        self.timer = node.create_timer(self.__period, self.update)
        node.add_post_set_parameters_callback(self._follow_parameter)

    def _declare(self, name: str, default: Any) -> Any:
        if not self.node.has_parameter(name):
            self.node.declare_parameter(name, default)
        return self.node.get_parameter(name).value

    def _follow_parameter(self, parameters: list[Any]) -> None:
        for parameter in parameters:
            if parameter.name == self.period_parameter:
                self.period = float(parameter.value)

    @property
    def period(self) -> float:
        """How often the tasks are run, in seconds."""
        return self.__period

    @period.setter
    def period(self, period: float) -> None:
        self.__period = period
        self.node.destroy_timer(self.timer)
        self.timer = self.node.create_timer(period, self.update)

    def update(self) -> None:
        """Run the tasks and publish the results."""
        with self.lock:
            tasks = list(self.tasks)
        results = [self._run(task) for task in tasks]
        all_ok = all(status.level == DiagnosticStatus.OK for status in results)
        if all_ok and not self.hwid and not self.warn_nohwid_done:
            self.node.get_logger().warning(
                "diagnostic_updater: no hardware ID was set; call setHardwareID, with 'none' where there is no hardware"
            )
            self.warn_nohwid_done = True
        self.publish(results)

    def _run(self, task: DiagnosticTaskVector.DiagnosticTaskInternal) -> DiagnosticStatusWrapper:
        status = DiagnosticStatusWrapper(
            level=DiagnosticStatus.ERROR, name=task.name, message="No message was set", hardware_id=self.hwid
        )
        status = task.run(status)
        if self.verbose and status.level != DiagnosticStatus.OK:
            self.node.get_logger().warning(
                f"Non-zero diagnostic status. Name: {status.name}, status {status.level[0]}: {status.message}"
            )
        return status

    def force_update(self) -> None:
        """Run the tasks and publish the results now, beside the period."""
        self.update()

    def broadcast(self, lvl: bytes | int, msg: str) -> None:
        """Publish a summary under the name of every task: something concerns them all."""
        with self.lock:
            names = [task.name for task in self.tasks]
        results = []
        for name in names:
            status = DiagnosticStatusWrapper(name=name, hardware_id=self.hwid)
            status.summary(lvl, msg)
            results.append(status)
        self.publish(results)

    def setHardwareID(self, hwid: str) -> None:
        """Set what identifies the hardware in every status; 'none' where there is none."""
        self.hwid = hwid

    def publish(self, msg: DiagnosticStatus | Sequence[DiagnosticStatus]) -> None:
        """Publish a status, or several in one message, their names led by the node's."""
        array = DiagnosticArray(
            status=[
                DiagnosticStatus(
                    level=status.level,
                    name=f"{self._prefix}: {status.name}",
                    message=status.message,
                    hardware_id=status.hardware_id,
                    values=status.values,
                )
                for status in ([msg] if isinstance(msg, DiagnosticStatus) else msg)
            ]
        )
        array.header.stamp = self.node.get_clock().now().to_msg()
        self.publisher.publish(array)

    def addedTaskCallback(self, task: DiagnosticTaskVector.DiagnosticTaskInternal) -> None:
        """Publish that a task has begun."""
        status = DiagnosticStatusWrapper(name=task.name)
        status.summary(DiagnosticStatus.OK, "Node starting up")
        self.publish(status)
