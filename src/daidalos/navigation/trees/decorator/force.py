"""Decorators with a fixed result."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Decorator


class ForceSuccess(Decorator):
    """Decorator that succeeds when its child has ended."""

    names = ("ForceSuccess",)
    RESULT: ClassVar[Status] = Status.SUCCESS

    def update(self) -> Status:
        """Replace every status except `RUNNING`."""
        return Status.RUNNING if self.decorated.status == Status.RUNNING else self.RESULT


class ForceFailure(ForceSuccess):
    """Decorator that fails when its child has ended."""

    names = ("ForceFailure",)
    RESULT: ClassVar[Status] = Status.FAILURE
