"""Conditions and scripts that every node of BehaviorTree.CPP 4 takes as attributes: ``_skipIf``, ``_onSuccess``..."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import py_trees
from py_trees.common import Status

from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.navigation.trees.scripts import Script

_BEFORE = {"_failureIf": Status.FAILURE, "_successIf": Status.SUCCESS, "_skipIf": Status.INVALID}
"""Conditions before a run, in the order in which they are checked, and the status that a true one gives."""

_AFTER = {
    "_onSuccess": frozenset({Status.SUCCESS}),
    "_onFailure": frozenset({Status.FAILURE}),
    "_post": frozenset({Status.SUCCESS, Status.FAILURE}),
}
"""Scripts after a run, in the order in which they run, and after which status."""

CONDITIONS = (*_BEFORE, "_while", *_AFTER, "_onHalted")
"""Names of the attributes."""


class Conditioned(py_trees.decorators.Decorator):  # type: ignore[misc]
    """Node with conditions and scripts.

    A node that is skipped is `INVALID` after its tick: its parent goes on as if the node were not there.

    Parameters
    ----------
    node : py_trees behaviour
        What is ticked.
    attributes : mapping of str to str
        Scripts by the names `CONDITIONS`.
    board : Blackboard
        What the scripts work on.
    where : str
        File, line and element, for errors.

    Raises
    ------
    TreeError
        A script is not of the language.
    """

    status: Status

    def __init__(self, node: Any, attributes: Mapping[str, str], board: Blackboard, where: str) -> None:
        shown = ", ".join(f"{name}: {text}" for name, text in attributes.items())
        super().__init__(f"{node.name} ({shown})", node)
        self._board = board
        self._scripts = {name: Script(text, f"{where}: {name}") for name, text in attributes.items()}

    def tick(self) -> Iterator[Any]:
        """Check the conditions, tick the node, and run the scripts of its end."""
        ended = self._status_without_tick()
        if ended is None:
            yield from self.decorated.tick()
            ended = self.decorated.status
        elif self.decorated.status == Status.RUNNING:
            self.decorated.stop(Status.INVALID)
            self._run("_onHalted")
        for name, statuses in _AFTER.items():
            if ended in statuses:
                self._run(name)
        self.status = ended
        yield self

    def update(self) -> Status:
        """Return the status of the node."""
        return self.decorated.status

    def terminate(self, new_status: Status) -> None:
        """Run the script of a halt."""
        if new_status == Status.INVALID and self.status == Status.RUNNING:
            self._run("_onHalted")

    def _status_without_tick(self) -> Status | None:
        """Return the status that a condition gives, None where the node is to be ticked."""
        if self.decorated.status != Status.RUNNING:
            for name, status in _BEFORE.items():
                if self._run(name):
                    return status
        return Status.INVALID if "_while" in self._scripts and not self._run("_while") else None

    def _run(self, name: str) -> Any:
        return self._scripts[name].run(self._board) if name in self._scripts else None
