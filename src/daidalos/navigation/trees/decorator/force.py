"""Say the same whatever the child says, once it has ended."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Decorator


class ForceSuccess(Decorator):
    """Succeeds when its child has ended."""

    names = ("ForceSuccess",)
    RESULT: ClassVar[Status] = Status.SUCCESS

    def update(self) -> Status:
        """Keep only `RUNNING`."""
        return Status.RUNNING if self.decorated.status == Status.RUNNING else self.RESULT


class ForceFailure(ForceSuccess):
    """Fails when its child has ended."""

    names = ("ForceFailure",)
    RESULT: ClassVar[Status] = Status.FAILURE
