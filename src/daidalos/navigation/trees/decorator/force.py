"""Decorators with a fixed result."""

from typing import ClassVar

from py_trees.common import Status

from daidalos.navigation.trees.node import Decorator


class ForceSuccess(Decorator):
    """Decorator that succeeds when its child has ended."""

    names = ("ForceSuccess",)
    RESULT: ClassVar[Status] = Status.SUCCESS

    def update(self) -> Status:
        """Replace success and failure."""
        status = self.decorated.status
        return self.RESULT if status in (Status.SUCCESS, Status.FAILURE) else status


class ForceFailure(ForceSuccess):
    """Decorator that fails when its child has ended."""

    names = ("ForceFailure",)
    RESULT: ClassVar[Status] = Status.FAILURE
