"""All children in turn, until one succeeds."""

from py_trees.common import Status

from daidalos.navigation.trees.in_turn import InTurn


class Fallback(InTurn):
    """Ticks one child after the other, going on with the one that runs; succeeds with the first that does."""

    names = ("Fallback",)
    goes_on_after = Status.FAILURE


class ReactiveFallback(Fallback):
    """Begins with the first child at every tick; halts a running child when one before it does not fail."""

    names = ("ReactiveFallback",)
    reactive = True
