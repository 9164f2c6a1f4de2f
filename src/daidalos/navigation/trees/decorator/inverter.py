"""Say the opposite of what the child says."""

from py_trees.common import Status

from daidalos.navigation.trees.node import Decorator


class Inverter(Decorator):
    """Succeeds when its child fails and the other way round."""

    names = ("Inverter",)

    def update(self) -> Status:
        """Turn the child's status round."""
        opposite = {Status.SUCCESS: Status.FAILURE, Status.FAILURE: Status.SUCCESS}
        return opposite.get(self.decorated.status, self.decorated.status)
