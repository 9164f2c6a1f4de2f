"""Iterator: a container that executes its state for each of some items."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from smach.container import Container
from smach.log import loginfo, logwarn
from smach.state import State
from smach.user_data import UserData
from smach.util import is_shutdown

Items = Iterable[Any] | Callable[[], Iterable[Any]]


class Iterator(Container):
    """Container of one state, which it executes for each of some items.

    Parameters
    ----------
    outcomes, input_keys, output_keys
        See `smach.State`.
    it
        The items, or a function that returns them.
    it_label
        The userdata with the current item.
    exhausted_outcome
        Outcome after the last item.
    """

    def __init__(
        self,
        outcomes: Iterable[str],
        input_keys: Iterable[str],
        output_keys: Iterable[str],
        it: Items = (),
        it_label: str = "it_data",
        exhausted_outcome: str = "exhausted",
    ) -> None:
        super().__init__([*outcomes, exhausted_outcome], input_keys, output_keys)
        self._items = it
        self._items_label = it_label
        self._is_running = False
        self._state_label = ""
        self._state = State()
        self._loop_outcomes: list[str] = []
        self._break_outcomes: list[str] = []
        self._final_outcome_map: dict[str, str] = {}
        self._exhausted_outcome = exhausted_outcome

    @staticmethod
    def set_iteritems(it: Items, it_label: str = "it_data") -> None:
        """Set the items of the opened iterator, and the userdata with the current one."""
        container = Iterator._currently_opened_container()
        container._items = it
        container._items_label = it_label

    @staticmethod
    def set_contained_state(
        label: str,
        state: State,
        loop_outcomes: Sequence[str] = (),
        break_outcomes: Sequence[str] = (),
        final_outcome_map: dict[str, str] | None = None,
    ) -> None:
        """Set the state of the opened iterator.

        Parameters
        ----------
        label
            Its name.
        state
            The state.
        loop_outcomes
            Outcomes of it after which the next item is taken; all others end the iteration.
        break_outcomes
            Outcomes of it that end the iteration; all others do not. Takes precedence.
        final_outcome_map
            Outcomes of the iterator by those of the state, where the two differ.
        """
        container = Iterator._currently_opened_container()
        container._state_label = label
        container._state = state
        outcomes = state.get_registered_outcomes()
        if loop_outcomes and break_outcomes:
            logwarn("Both loop_outcomes and break_outcomes were specified: break_outcomes are used.")
        if break_outcomes:
            container._break_outcomes = list(break_outcomes)
            container._loop_outcomes = [one for one in outcomes if one not in break_outcomes]
        else:
            container._loop_outcomes = list(loop_outcomes)
            container._break_outcomes = [one for one in outcomes if one not in loop_outcomes]
        container._final_outcome_map = dict(final_outcome_map or {})

    def execute(self, parent_ud: Any = None) -> str | None:
        """Execute the state for each item, and return the outcome."""
        self._is_running = True
        self._copy_input_keys(parent_ud, self.userdata)
        self.call_start_cbs()
        outcome: str | None = self._exhausted_outcome
        try:
            for item in self._items() if callable(self._items) else self._items:
                if is_shutdown():
                    break
                loginfo(f"Iterating {item} of {self._items}")
                self.userdata[self._items_label] = item
                last = self._execute_child(self._state_label, self._state, self.userdata)
                if self._preempt_requested or last in self._break_outcomes:
                    self._preempt_requested = False
                    outcome = last
                    break
                self.call_transition_cbs()
        finally:
            self._is_running = False
        outcome = self._final_outcome_map.get(str(outcome), outcome)
        self._copy_output_keys(self.userdata, parent_ud)
        self.call_termination_cbs([self._state_label], outcome)
        return outcome

    def request_preempt(self) -> None:
        """Request that the iteration ends, by the state."""
        self._preempt_requested = True
        if self._is_running:
            self._state.request_preempt()

    def get_children(self) -> dict[str, Any]:
        """Return the state by its label."""
        return {self._state_label: self._state}

    def get_initial_states(self) -> list[str]:
        """Return the label of the state in a list."""
        return [self._state_label]

    def set_initial_state(self, initial_states: Sequence[str], userdata: UserData) -> None:
        """Add userdata; raises KeyError for another state than the only one."""
        if initial_states and initial_states[0] != self._state_label:
            logwarn(f"'{initial_states[0]}' is not the state of this iterator, which is '{self._state_label}'.")
            raise KeyError(initial_states[0])
        self.userdata.update(userdata)

    def get_active_states(self) -> list[str]:
        """Return the label of the state in a list, none while it is not executed."""
        return [self._state_label] if self._is_running else []

    def get_internal_edges(self) -> list[tuple[Any, ...]]:
        """Return the transitions: [(outcome, label from, label or outcome to)]; None to the outcome's own name."""
        loops = [(outcome, self._state_label, self._state_label) for outcome in self._loop_outcomes]
        ends = [(outcome, self._state_label, self._final_outcome_map.get(outcome)) for outcome in self._break_outcomes]
        return [*loops, *ends]

    def check_consistency(self) -> None:
        """Accept whatever the iterator consists of."""
