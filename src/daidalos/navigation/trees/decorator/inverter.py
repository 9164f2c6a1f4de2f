"""Decorator that inverts the result of its child."""

from py_trees.common import Status

from daidalos.navigation.trees.node import Decorator


class Inverter(Decorator):
    """Decorator that exchanges success and failure of its child."""

    names = ("Inverter",)

    def update(self) -> Status:
        """Return the inverted status of the child."""
        opposite = {Status.SUCCESS: Status.FAILURE, Status.FAILURE: Status.SUCCESS}
        return opposite.get(self.decorated.status, self.decorated.status)
