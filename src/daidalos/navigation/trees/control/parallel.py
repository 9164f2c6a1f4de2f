"""Nodes that tick all their children in one tick."""

from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Control, Port

_ENDED = (Status.SUCCESS, Status.FAILURE)


class _AtOnce(Control):
    """Control node that ticks each child until it has ended, then as `_outcome` says."""

    def tick(self) -> Iterator[Any]:
        """Tick the children that have not ended; those that were skipped are tried again."""
        for child in self.children:
            if self.status != Status.RUNNING or child.status not in _ENDED:
                yield from child.tick()
        self.conclude(self._outcome([child.status for child in self.children]))
        yield self

    def _outcome(self, statuses: list[Status]) -> Status:
        raise NotImplementedError


class Parallel(_AtOnce):
    """Control node that succeeds after `success_count` successes of its children, and fails after `failure_count`.

    Negative numbers count from the number of children, -1 being all. It fails too when the successes cannot be
    reached any more.
    """

    names = ("Parallel",)
    PORTS: ClassVar[dict[str, Port]] = {
        "success_count": Port(int, -1),
        "failure_count": Port(int, 1),
        "success_threshold": Port(int, None),
        "failure_threshold": Port(int, None),
    }

    def _outcome(self, statuses: list[Status]) -> Status:
        if all(status == Status.INVALID for status in statuses):
            return Status.INVALID
        successes, failures = self._wanted("success", len(statuses)), self._wanted("failure", len(statuses))
        succeeded = statuses.count(Status.SUCCESS)
        if self._number("success") < 0:
            succeeded += statuses.count(Status.INVALID)
        failed = statuses.count(Status.FAILURE)
        if succeeded >= successes:
            return Status.SUCCESS
        if failed >= failures or len(statuses) - failed < successes:
            return Status.FAILURE
        return Status.RUNNING

    def _wanted(self, kind: str, children: int) -> int:
        number = self._number(kind)
        return number if number >= 0 else max(children + number + 1, 0)

    def _number(self, kind: str) -> int:
        """Return the port of version 4, or that of version 3 where the tree gives it."""
        older = self.ports.get(f"{kind}_threshold")
        return int(self.ports.get(f"{kind}_count") if older is None else older)


class ParallelAll(_AtOnce):
    """Control node that waits for the end of all its children; it fails if `max_failures` of them or more have."""

    names = ("ParallelAll",)
    PORTS: ClassVar[dict[str, Port]] = {"max_failures": Port(int, 1)}

    def _outcome(self, statuses: list[Status]) -> Status:
        if Status.RUNNING in statuses:
            return Status.RUNNING
        if all(status == Status.INVALID for status in statuses):
            return Status.INVALID
        limit = self.ports.get("max_failures")
        allowed = limit if limit >= 0 else max(len(statuses) + limit + 1, 0)
        return Status.FAILURE if statuses.count(Status.FAILURE) >= allowed else Status.SUCCESS


class NonblockingSequence(_AtOnce):
    """Control node that ticks all its children until they have succeeded together; it fails with the first that does.

    A child that has ended is ticked again as long as another one runs.
    """

    names = ("NonblockingSequence",)

    def tick(self) -> Iterator[Any]:
        """Tick each child until one fails."""
        for child in self.children:
            yield from child.tick()
            if child.status == Status.FAILURE:
                break
        self.conclude(self._outcome([child.status for child in self.children]))
        yield self

    def _outcome(self, statuses: list[Status]) -> Status:
        for status in (Status.FAILURE, Status.RUNNING, Status.SUCCESS):
            if status in statuses:
                return status
        return Status.INVALID
