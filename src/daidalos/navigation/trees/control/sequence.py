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


class AsyncSequence(Sequence):
    """Sequence that ticks at most one child that succeeds in each tick."""

    names = ("AsyncSequence",)
    pauses = True


class SequenceWithMemory(InTurn):
    """Control node that ticks children in order until one fails, and goes on with that one at the next tick."""

    names = ("SequenceWithMemory", "SequenceStar")
    goes_on_after = Status.SUCCESS
    remembers = True
