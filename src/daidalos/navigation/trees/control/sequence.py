"""Sequence nodes."""

from py_trees.common import Status

from daidalos.navigation.trees.in_turn import InTurn


class Sequence(InTurn):
    """Control node that ticks children in order, resuming the running one, until one fails."""

    names = ("Sequence",)
    goes_on_after = Status.SUCCESS


class ReactiveSequence(Sequence):
    """Control node that ticks from the first child each time; halts a running child if an earlier one runs or fails."""

    names = ("ReactiveSequence",)
    reactive = True
