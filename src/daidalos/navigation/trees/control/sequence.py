"""All children in turn, as long as they succeed."""

from py_trees.common import Status

from daidalos.navigation.trees.in_turn import InTurn


class Sequence(InTurn):
    """Ticks one child after the other, going on with the one that runs; fails with the first that fails."""

    names = ("Sequence",)
    goes_on_after = Status.SUCCESS


class ReactiveSequence(Sequence):
    """Begins with the first child at every tick; halts a running child when one before it runs or fails."""

    names = ("ReactiveSequence",)
    reactive = True
