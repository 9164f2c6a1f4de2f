"""Concurrence: a container that executes all of its states at the same time."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from smach.container import Container
from smach.exceptions import InvalidStateError, InvalidTransitionError, InvalidUserCodeError
from smach.log import logerr, loginfo, logwarn
from smach.state import State
from smach.state_machine import AnyState
from smach.user_data import UserData

Outcomes = dict[str, str | None]


class Concurrence(Container):
    """Container whose states are executed in threads; it ends after the last of them.

    Parameters
    ----------
    outcomes, input_keys, output_keys
        See `smach.State`.
    default_outcome
        Outcome where nothing else determines it.
    outcome_map
        By outcome of the container, the outcomes of states, by label, that lead to it. Of several that fit, the one
        with the most states counts.
    outcome_cb
        Called with the outcomes of all states by label after the last has ended; returns the outcome, or None for
        that of the map.
    child_termination_cb
        Called with the outcomes of all states, None for those that are executed, each time a state has ended;
        returns whether to preempt all others, or the labels of those to preempt.
    """

    def __init__(
        self,
        outcomes: Iterable[str],
        default_outcome: str,
        input_keys: Iterable[str] = (),
        output_keys: Iterable[str] = (),
        outcome_map: Mapping[str, Mapping[str, str]] | None = None,
        outcome_cb: Callable[[Outcomes], str | None] | None = None,
        child_termination_cb: Callable[[Outcomes], Any] | None = None,
    ) -> None:
        outcomes = list(outcomes)
        super().__init__(outcomes, input_keys, output_keys)
        self._default_outcome = default_outcome
        self._outcome_map = dict(outcome_map or {})
        self._outcome_cb = outcome_cb
        self._child_termination_cb = child_termination_cb
        self._check_policy(outcomes)
        self._states: dict[str, State] = {}
        self._remappings: dict[str, Mapping[str, str]] = {}
        self._child_outcomes: Outcomes = {}
        self._running: set[str] = set()
        self._failed = False
        self._preempt_children: set[str] = set()
        self._changed = threading.Condition()

    def _check_policy(self, outcomes: list[str]) -> None:
        faults = [f"Unregistered outcome '{one}' in outcome_map." for one in self._outcome_map if one not in outcomes]
        if self._default_outcome not in outcomes:
            faults.append(f"Default outcome '{self._default_outcome}' is unregistered.")
        for name, callback in (("Outcome", self._outcome_cb), ("Child termination", self._child_termination_cb)):
            if callback is not None and not callable(callback):
                faults.append(f"{name} callback '{callback}' is not callable.")
        if faults:
            raise InvalidStateError(f"Errors specifying outcome policy of concurrence: {' '.join(faults)}")

    @staticmethod
    def add(label: str, state: AnyState, remapping: Mapping[str, str] | None = None) -> AnyState:
        """Add a state to the opened concurrence, and return it.

        Parameters
        ----------
        label
            Its name in the container.
        state
            The state.
        remapping
            Names of userdata in the container by their names in the state, where the two differ.
        """
        container = Concurrence._currently_opened_container()
        if label in container._states:
            raise InvalidStateError(f"The label '{label}' is already being used.")
        container._states[label] = state
        container._remappings[label] = remapping or {}
        return state

    def execute(self, parent_ud: Any = None) -> str | None:
        """Execute all states, and return the outcome after the last has ended."""
        with self._changed:
            self._child_outcomes = dict.fromkeys(self._states)
            self._running = set(self._states)
            self._failed = False
            self._preempt_children = set()
        self._copy_input_keys(parent_ud, self.userdata)
        loginfo(f"Concurrence starting with userdata: \n\t{self.userdata.keys()}")
        self.call_start_cbs()
        threads = [
            threading.Thread(name=f"concurrent_split:{label}", target=self._run_child, args=(label,))
            for label in self._states
        ]
        for thread in threads:
            thread.start()
        self._preempt_until_done()
        for thread in threads:
            thread.join()
        if self._failed:
            raise InvalidStateError("A concurrent state raised an exception during execution.")
        if self.preempt_requested():
            self._service_preempt()
        outcomes = dict(self._child_outcomes)
        loginfo(f"Concurrent Outcomes: {outcomes}")
        outcome = self._outcome(outcomes)
        self.call_termination_cbs(list(self._states), outcome)
        self._copy_output_keys(self.userdata, parent_ud)
        return outcome

    def _preempt_until_done(self) -> None:
        """Request states to end, as soon as and where it is due, until all have ended."""
        requested: set[str] = set()
        while True:
            with self._changed:
                self._changed.wait_for(lambda: not self._running or self._due() - requested)
                if not self._running:
                    return
                due = self._due() - requested
            for label in due:
                requested.add(label)
                self._states[label].request_preempt()

    def _due(self) -> set[str]:
        """Return the executed states that are to end."""
        everyone = self._failed or self.preempt_requested()
        return set(self._running) if everyone else self._running & self._preempt_children

    def _run_child(self, label: str) -> None:
        self.call_transition_cbs()
        state = self._states[label]
        outcome = None
        failed = True
        try:
            outcome = self._execute_child(label, state, self._seen_by(state, self._remappings[label]))
            failed = outcome is None
            if failed:
                logerr(f"Concurrent state '{label}' returned no outcome on termination.")
            else:
                loginfo(f"Concurrent state '{label}' returned outcome '{outcome}' on termination.")
        except InvalidUserCodeError:
            logerr(f"Could not execute child state '{label}'.")  # and why is logged
        finally:
            with self._changed:
                self._child_outcomes[label] = outcome
                self._running.discard(label)
                self._failed = self._failed or failed
                self._preempt_children |= self._children_to_preempt()
                self._changed.notify_all()
            self.call_transition_cbs()

    def _children_to_preempt(self) -> set[str]:
        if self._child_termination_cb is None:
            return set()
        try:
            wanted = self._child_termination_cb(dict(self._child_outcomes))
        except Exception:  # code of the user's may raise anything
            logerr(f"Could not execute child termination callback: {traceback.format_exc()}")
            self._failed = True
            return set()
        if isinstance(wanted, str):
            return {wanted}
        return set(wanted) if isinstance(wanted, list | tuple | set) else set(self._states) if wanted else set()

    def _service_preempt(self) -> None:
        ignored = [label for label, state in self._states.items() if state.preempt_requested()]
        for label in ignored:
            logwarn(f"State '{label}' in concurrence did not service preempt.")
            self._states[label].recall_preempt()
        if not ignored:
            loginfo("Concurrence serviced preempt.")
            self.service_preempt()

    def _outcome(self, outcomes: Outcomes) -> str:
        fitting = [
            (len(wanted), name)
            for name, wanted in self._outcome_map.items()
            if all(outcomes.get(label) == one for label, one in wanted.items())
        ]
        outcome = max(fitting, key=lambda one: one[0])[1] if fitting else self._default_outcome
        if self._outcome_cb is None:
            return outcome
        try:
            chosen = self._outcome_cb(dict(outcomes))
        except Exception:  # code of the user's may raise anything
            raise InvalidUserCodeError(f"Could not execute outcome callback: {traceback.format_exc()}") from None
        if chosen is not None and not isinstance(chosen, str):
            logerr(f"Outcome callback returned {chosen!r}, which is not a string: using '{outcome}'.")
            return outcome
        return chosen or outcome

    def request_preempt(self) -> None:
        """Request that all states end."""
        super().request_preempt()
        with self._changed:
            self._changed.notify_all()

    def get_children(self) -> dict[str, Any]:
        """Return the states by label."""
        return self._states

    def get_initial_states(self) -> list[str]:
        """Return the labels of all states."""
        return list(self._states)

    def set_initial_state(self, initial_states: Sequence[str], userdata: UserData) -> None:
        """Add userdata; the states to begin with are always all."""
        if initial_states and set(initial_states) != set(self._states):
            logwarn("The states of a concurrence are always all executed: the initial states are ignored.")
        self.userdata.update(userdata)

    def get_active_states(self) -> list[str]:
        """Return the labels of the states that are executed."""
        with self._changed:
            return [label for label in self._states if label in self._running]

    def get_internal_edges(self) -> list[tuple[Any, ...]]:
        """Return the outcome map: [(outcome of the state, its label, outcome of the container)]."""
        return [
            (outcome, label, name) for name, wanted in self._outcome_map.items() for label, outcome in wanted.items()
        ]

    def check_consistency(self) -> None:
        """Raise InvalidTransitionError for a state or an outcome of the map that does not exist."""
        for wanted in self._outcome_map.values():
            for label, outcome in wanted.items():
                if label not in self._states or outcome not in self._states[label].get_registered_outcomes():
                    raise InvalidTransitionError(
                        f"The outcome map has outcome '{outcome}' of state '{label}', which does not exist."
                    )
