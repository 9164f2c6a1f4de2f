"""Sequence: a state machine whose states follow each other in the order in which they are added."""

from __future__ import annotations

from collections.abc import Iterable

from smach.state_machine import AnyState, StateMachine


class Sequence(StateMachine):
    """State machine in which one outcome of each state leads to the state that is added next.

    Parameters
    ----------
    outcomes, input_keys, output_keys
        See `smach.State`.
    connector_outcome
        The outcome.
    """

    def __init__(
        self,
        outcomes: Iterable[str],
        connector_outcome: str,
        input_keys: Iterable[str] = (),
        output_keys: Iterable[str] = (),
    ) -> None:
        super().__init__(outcomes, input_keys, output_keys)
        self._last_added_seq_label: str | None = None
        self._connector_outcome = connector_outcome

    @staticmethod
    def add(
        label: str,
        state: AnyState,
        transitions: dict[str, str | None] | None = None,
        remapping: dict[str, str] | None = None,
    ) -> AnyState:
        """Add a state to the opened sequence; see `StateMachine.add`. A given transition is kept."""
        sequence = Sequence._currently_opened_container()
        StateMachine.add(label, state, transitions, remapping)
        last = sequence._last_added_seq_label
        if last is not None and sequence._transitions[last].get(sequence._connector_outcome) is None:
            sequence._transitions[last][sequence._connector_outcome] = label
        sequence._last_added_seq_label = label
        return state
