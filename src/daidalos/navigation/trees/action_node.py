"""Base of action nodes: starts a task, polls it, and stops it when halted."""

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from py_trees.common import Status

from daidalos.navigation.trees.node import Node, Port, Ports, TreeContext
from daidalos.navigation.trees.services import NO_ERROR, Task

RECOVERIES = "number_recoveries"
"""Name on the blackboard under which recovery actions are counted."""

SERVER: dict[str, Port] = {"server_name": Port(str, None), "server_timeout": Port(float, None)}
"""Inputs of every node that calls an action server."""

ERRORS: dict[str, Port] = {"error_code_id": Port(str, output=True), "error_msg": Port(str, output=True)}
"""Outputs of every node that calls an action server: the `ErrorCode`, and the reason for people."""


class ActionNode(Node):
    """Action node that runs the task of its name; subclasses declare their ports.

    Attributes
    ----------
    INTERFACE : str
        Type of the action or service, such as ``nav2_msgs/action/Spin``; empty for one named as the class.
    SERVER : str
        Name of the action's server, or of the service, where the tree names none.
    UPDATES : tuple of str
        Inputs that are passed on to the running task when they change.
    RECOVERY : bool
        Whether it counts as a recovery; an input `is_recovery` overrules.
    HAS_FEEDBACK : bool
        Whether fields of the action's feedback are output while it runs.
    """

    INTERFACE: ClassVar[str] = ""
    SERVER: ClassVar[str] = ""
    UPDATES: ClassVar[tuple[str, ...]] = ()
    RECOVERY: ClassVar[bool] = False
    HAS_FEEDBACK: ClassVar[bool] = False

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        super().__init__(ports, context)
        self._task: Task | None = None
        self._sent: dict[str, Any] = {}

    @classmethod
    def goal(cls, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """Return the fields of the action's goal or the service's request, such as ``target.x``; durations in seconds.

        By default those that the ports name.
        """
        return {cls.PORTS[name].field or name: value for name, value in inputs.items()}

    @classmethod
    def service(cls, inputs: Mapping[str, Any]) -> str:
        """Return the name of the service that is called; by default the input `service_name`."""
        return str(inputs.get("service_name") or cls.SERVER)

    @classmethod
    def is_success(cls, response: Any) -> bool:
        """Return whether a service's response means success; by default each does."""
        return True

    @classmethod
    def outputs(cls, result: Any) -> dict[str, Any]:
        """Return values of output ports from the action's result; by default the fields that they name."""
        outputs = {name: port.field or name for name, port in cls.PORTS.items() if port.output and name not in ERRORS}
        return {name: getattr(result, field) for name, field in outputs.items() if hasattr(result, field)}

    def written(self, outputs: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the values of output ports at the end, from the task's outputs; by default these."""
        return outputs

    def initialise(self) -> None:
        """Start the task."""
        self._sent = self.ports.inputs()
        if self._sent.get("is_recovery", self.RECOVERY):
            count = self.ports.blackboard.get(RECOVERIES, 0)
            self.ports.blackboard.set(RECOVERIES, count + 1)
        self.ports.set("error_code_id", NO_ERROR)
        self._task = self.services.start(type(self), self._sent)

    def update(self) -> Status:
        """Poll the task."""
        if self._task is None:
            return Status.FAILURE
        for key, value in self._task.feedback().items() if self.HAS_FEEDBACK else ():
            self.ports.set(key, value)
        outcome = self._task.poll()
        if outcome is None:
            self._pass_changes_on(self._task)
            return Status.RUNNING
        self._task = None
        for key, value in self.written(outcome.outputs).items():
            self.ports.set(key, value)
        self.ports.set("error_code_id", outcome.error_code)
        self.ports.set("error_msg", outcome.error_msg)
        self.feedback_message = outcome.error_msg
        return Status.SUCCESS if outcome.succeeded else Status.FAILURE

    def terminate(self, new_status: Status) -> None:
        """Stop the task if it still runs."""
        if self._task is not None and new_status == Status.INVALID:
            self._task.halt()
            self._task = None

    def _pass_changes_on(self, task: Task) -> None:
        latest = self.ports.inputs()
        if any(differs(latest.get(key), self._sent.get(key)) for key in self.UPDATES):
            self._sent = latest
            task.update(latest)


def differs(one: Any, other: Any) -> bool:
    """Return whether two values of the blackboard differ, arrays or not."""
    return one is not other and not np.array_equal(one, other)


def with_server(ports: Mapping[str, Port]) -> dict[str, Port]:
    """Return the ports of a node that calls an action server: its own, and the common ones."""
    return {**ports, **SERVER, **ERRORS}
