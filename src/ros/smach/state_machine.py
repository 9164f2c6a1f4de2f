"""State machine: states, one of which is active, and transitions between them."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeVar

from smach.container import Container
from smach.exceptions import InvalidStateError, InvalidTransitionError
from smach.log import logerr, loginfo, logwarn
from smach.state import State
from smach.user_data import UserData
from smach.util import is_shutdown

AnyState = TypeVar("AnyState", bound=State)


class StateMachine(Container):
    """Container in which one state is active at a time.

    Parameters
    ----------
    outcomes, input_keys, output_keys
        See `smach.State`.
    """

    def __init__(
        self, outcomes: Iterable[str], input_keys: Iterable[str] = (), output_keys: Iterable[str] = ()
    ) -> None:
        super().__init__(outcomes, input_keys, output_keys)
        self._state_transitioning_lock = threading.Lock()
        self._is_running = False
        self._initial_state_label: str | None = None
        self._current_label: str | None = None
        self._preempted_label: str | None = None
        self._states: dict[str, State] = {}
        self._transitions: dict[str, dict[str, str | None]] = {}
        self._remappings: dict[str, dict[str, str]] = {}
        self._last_added_label: str | None = None
        self._connector_outcomes: Sequence[str] = ()

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "_state_transitioning_lock"}

    def __setstate__(self, content: dict[str, Any]) -> None:
        vars(self).update(content)
        self._state_transitioning_lock = threading.Lock()

    @staticmethod
    def add(
        label: str,
        state: AnyState,
        transitions: dict[str, str | None] | None = None,
        remapping: dict[str, str] | None = None,
    ) -> AnyState:
        """Add a state to the opened state machine, and return it; the first one is the initial state.

        Parameters
        ----------
        label
            Its name in the state machine.
        state
            The state.
        transitions
            Labels of states, or outcomes of the state machine, by outcome of the state. Other outcomes are those of
            the state machine, too.
        remapping
            Names of userdata in the state machine by their names in the state, where the two differ.

        Raises
        ------
        InvalidStateError
            When there is a state of this label, or no state machine is open.
        InvalidTransitionError
            When the state does not have an outcome.
        """
        machine = StateMachine._currently_opened_container()
        machine._add(label, state, dict(transitions or {}), dict(remapping or {}))
        return state

    def _add(self, label: str, state: State, transitions: dict[str, str | None], remapping: dict[str, str]) -> None:
        self.check_state_spec(label, state, transitions)
        if label in self._states:
            raise InvalidStateError(
                f'Attempting to add state with label "{label}" to state machine, but this label is already being used.'
            )
        if self._initial_state_label is None:
            self._initial_state_label = label
        self._states[label] = state
        self._transitions[label] = {**dict.fromkeys(state.get_registered_outcomes()), **transitions}
        self._remappings[label] = remapping
        if self._last_added_label is not None:
            for outcome in self._connector_outcomes:
                self._transitions[self._last_added_label][outcome] = label
            self._connector_outcomes, self._last_added_label = (), None

    @staticmethod
    def add_auto(
        label: str,
        state: AnyState,
        connector_outcomes: Sequence[str],
        transitions: dict[str, str | None] | None = None,
        remapping: dict[str, str] | None = None,
    ) -> AnyState:
        """Add a state some of whose outcomes lead to the state that is added next; see `add`."""
        machine = StateMachine._currently_opened_container()
        StateMachine.add(label, state, transitions, remapping)
        registered = state.get_registered_outcomes()
        if not set(connector_outcomes) <= set(registered):
            raise InvalidStateError(
                f"Attempting to auto-connect states with outcomes {connector_outcomes}, but state '{label}' only has "
                f"registered outcomes: {registered}"
            )
        machine._last_added_label = label
        machine._connector_outcomes = connector_outcomes
        return state

    def execute(self, parent_ud: Any = None) -> str | None:
        """Execute states from the initial one until a transition leads to an outcome, and return it."""
        with self._state_transitioning_lock:
            try:
                self.check_consistency()
            except (InvalidStateError, InvalidTransitionError):
                logerr("Container consistency check failed.")
                return None
            self._is_running = True
            self._preempted_label = None
            self._current_label = self._initial_state_label
            self._copy_input_keys(parent_ud, self.userdata)
            loginfo(
                f"State machine starting in initial state '{self._current_label}' with userdata: \n\t"
                f"{self.userdata.keys()}"
            )
            self.call_start_cbs()
            outcome = None
            try:
                while outcome is None and self._is_running and not is_shutdown():
                    outcome = self._update_once()
            finally:
                self._is_running = False
            self._copy_output_keys(self.userdata, parent_ud)
        return outcome

    def _update_once(self) -> str | None:
        """Execute the current state and make its transition; return the outcome if it leads to one."""
        label = self._current_label
        if label is None or label not in self._states:
            raise InvalidStateError(f"State '{label}' does not exist. Available states are: {list(self._states)}")
        state = self._states[label]
        self._pass_on_preempt(label)
        # While a state is executed, `request_preempt` may be called.
        self._state_transitioning_lock.release()
        try:
            outcome = self._execute_child(label, state, self._seen_by(state, self._remappings[label]))
        finally:
            self._state_transitioning_lock.acquire()
        if outcome not in state.get_registered_outcomes():
            raise InvalidTransitionError(
                f"Attempted to return outcome '{outcome}' from state '{label}' of type '{type(state).__name__}' which "
                f"only has registered outcomes: {state.get_registered_outcomes()}"
            )
        target = self._transitions[label].get(outcome)
        if target in self._states:
            self._current_label = target
            loginfo(f"State machine transitioning '{label}':'{outcome}'-->'{target}'")
            self.call_transition_cbs()
            return None
        if self._preempt_requested and self._preempted_label is not None and not state.preempt_requested():
            self.service_preempt()
        if target not in self.get_registered_outcomes():
            target = outcome
        if target not in self.get_registered_outcomes():
            raise InvalidTransitionError(
                f"Outcome '{outcome}' of state '{label}' with transition target '{target}' is neither a registered "
                "state nor a registered container outcome."
            )
        self._current_label = None
        loginfo(f"State machine terminating '{label}':'{outcome}':'{target}'")
        self.call_termination_cbs([label], target)
        return target

    def _pass_on_preempt(self, label: str) -> None:
        """Preempt the next state if the last one did not end on request."""
        if not self.preempt_requested():
            return
        loginfo("Preempt requested on state machine before executing the next state.")
        last = self._preempted_label
        if last is None:
            self._preempt_current_state()
        elif self._states[last].preempt_requested():
            loginfo(f"Last state '{last}' did not service preempt. Preempting next state '{label}' before executing...")
            self._preempt_current_state()
        else:
            self._preempt_requested = False
            self._preempted_label = None

    def request_preempt(self) -> None:
        """Request that the state machine ends, by the current state."""
        with self._state_transitioning_lock:
            self._preempt_requested = True
            if self._current_label is not None:
                self._preempt_current_state()

    def _preempt_current_state(self) -> None:
        current = self._current_label
        if current is None or self._preempted_label == current:
            return
        if self._preempted_label is not None:
            self._states[self._preempted_label].recall_preempt()
        self._preempted_label = current
        try:
            self._states[current].request_preempt()
        except Exception:  # code of the user's may raise anything
            logerr(f"Failed to preempt contained state '{current}': {traceback.format_exc()}")

    def get_children(self) -> dict[str, Any]:
        """Return the states by label."""
        return self._states

    def set_initial_state(self, initial_states: Sequence[str], userdata: UserData | None = None) -> None:
        """Set the label of the state to begin with, the first of a list, and add userdata."""
        if len(initial_states) > 1:
            logwarn(f"A state machine has one initial state: taking the first one of {list(initial_states)}.")
        if initial_states:
            self._initial_state_label = initial_states[0]
        if userdata is not None:
            self.userdata.update(userdata)

    def get_active_states(self) -> list[str]:
        """Return the label of the current state in a list."""
        return [str(self._current_label)]

    def get_initial_states(self) -> list[str]:
        """Return the label of the initial state in a list."""
        return [str(self._initial_state_label)]

    def get_internal_edges(self) -> list[tuple[Any, ...]]:
        """Return the transitions: [(outcome, label from, label or outcome to)]."""
        return [
            (outcome, label, target)
            for label, transitions in self._transitions.items()
            for outcome, target in transitions.items()
        ]

    def check_state_spec(self, label: str, state: State, transitions: Mapping[str, str | None]) -> None:
        """Raise InvalidTransitionError unless a state has the outcomes of its transitions."""
        registered = state.get_registered_outcomes()
        for outcome in transitions:
            if outcome not in registered:
                raise InvalidTransitionError(
                    f"Specified outcome '{outcome}' on state '{label}', which only has available registered outcomes: "
                    f"{registered}"
                )

    def check_consistency(self) -> None:
        """Check that there is an initial state and that transitions lead to states or outcomes.

        Raises
        ------
        InvalidTransitionError
            Naming all faults.
        """
        faults = []
        outcomes = set(self.get_registered_outcomes())
        if self._initial_state_label is None:
            faults.append("No initial state set.")
        elif self._initial_state_label not in self._states:
            faults.append(f"Initial state label: '{self._initial_state_label}' is not in the state machine.")
        for label, transitions in self._transitions.items():
            unknown = {target for target in transitions.values() if target} - self._states.keys() - outcomes
            if unknown:
                faults.append(f"State '{label}' references unknown states: {sorted(unknown)}")
            open_ends = {outcome for outcome, target in transitions.items() if not target} - outcomes
            if open_ends:
                faults.append(f"State '{label}' references unregistered outcomes: {sorted(open_ends)}")
        if faults:
            listed = "".join(f"\n\t{fault}" for fault in faults)
            available = sorted(self._states.keys() | outcomes)
            raise InvalidTransitionError(
                f"State machine failed consistency check: {listed}\n\n\tAvailable states: {available}"
            )

    def is_running(self) -> bool:
        """Return whether the state machine is executed."""
        return self._is_running
