"""Fallback nodes."""

from py_trees.common import Status

from daidalos.navigation.trees.in_turn import InTurn


class Fallback(InTurn):
    """Control node that ticks children in order, resuming the running one, until one succeeds."""

    names = ("Fallback",)
    goes_on_after = Status.FAILURE


class ReactiveFallback(Fallback):
    """Control node that ticks from the first child each time; halts a running child if an earlier one does not fail."""

    names = ("ReactiveFallback",)
    reactive = True


class AsyncFallback(Fallback):
    """Fallback that ticks at most one child that fails in each tick."""

    names = ("AsyncFallback",)
    pauses = True
