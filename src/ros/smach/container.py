"""Containers: states that consist of states."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import TracebackType
from typing import Any, ClassVar, Self, cast

from smach.exceptions import InvalidConstructionError, InvalidStateError, InvalidTransitionError, InvalidUserCodeError
from smach.log import logerr, logwarn
from smach.state import State
from smach.user_data import Remapper, UserData

Callbacks = list[tuple[Callable[..., Any], Sequence[Any]]]


class Container(State):
    """Base of containers, opened for construction in a ``with`` block.

    Parameters
    ----------
    outcomes, input_keys, output_keys
        See `smach.State`.
    """

    _construction_stack: ClassVar[list[Container]] = []
    _construction_lock: ClassVar[Any] = threading.RLock()

    def __init__(
        self, outcomes: Iterable[str] = (), input_keys: Iterable[str] = (), output_keys: Iterable[str] = ()
    ) -> None:
        super().__init__(outcomes, input_keys, output_keys)
        self.userdata = UserData()
        self._start_cbs: Callbacks = []
        self._transition_cbs: Callbacks = []
        self._termination_cbs: Callbacks = []

    def __getitem__(self, key: str) -> State:
        found = self.get_children().get(key)
        if found is None:
            logerr(f"There is no state '{key}'. The only available states are: {list(self.get_children())}")
            raise KeyError(key)
        return cast(State, found)

    def get_children(self) -> dict[str, Any]:
        """Return the states of this container by label."""
        raise NotImplementedError

    def set_initial_state(self, initial_states: Sequence[str], userdata: UserData) -> None:
        """Set the labels of the states to begin with, and add userdata."""
        raise NotImplementedError

    def get_initial_states(self) -> list[str]:
        """Return the labels of the states to begin with."""
        raise NotImplementedError

    def get_active_states(self) -> list[str]:
        """Return the labels of the states that are executed."""
        raise NotImplementedError

    def get_internal_edges(self) -> list[tuple[Any, ...]]:
        """Return the transitions inside of this container: [(outcome, label from, label to)]."""
        raise NotImplementedError

    def check_consistency(self) -> None:
        """Check what the container consists of; raises InvalidStateError or InvalidTransitionError."""
        raise NotImplementedError

    def register_start_cb(self, start_cb: Callable[..., Any], cb_args: Sequence[Any] = ()) -> None:
        """Call ``start_cb(userdata, initial_states, *cb_args)`` when the container is entered."""
        self._start_cbs.append((start_cb, cb_args))

    def register_transition_cb(self, transition_cb: Callable[..., Any], cb_args: Sequence[Any] = ()) -> None:
        """Call ``transition_cb(userdata, active_states, *cb_args)`` at each transition."""
        self._transition_cbs.append((transition_cb, cb_args))

    def register_termination_cb(self, termination_cb: Callable[..., Any], cb_args: Sequence[Any] = ()) -> None:
        """Call ``termination_cb(userdata, terminal_states, outcome, *cb_args)`` when the container is left."""
        self._termination_cbs.append((termination_cb, cb_args))

    def call_start_cbs(self) -> None:
        """Call the functions of `register_start_cb`."""
        self._call("start", self._start_cbs, self.get_initial_states())

    def call_transition_cbs(self) -> None:
        """Call the functions of `register_transition_cb`."""
        self._call("transition", self._transition_cbs, self.get_active_states())

    def call_termination_cbs(self, terminal_states: Sequence[str], outcome: str | None) -> None:
        """Call the functions of `register_termination_cb`."""
        self._call("termination", self._termination_cbs, terminal_states, outcome)

    def _call(self, what: str, callbacks: Callbacks, *arguments: Any) -> None:
        for callback, more in callbacks:
            try:
                callback(self.userdata, *arguments, *more)
            except Exception:  # code of the user's may raise anything
                logerr(f"Could not execute {what} callback: {traceback.format_exc()}")

    def _copy_input_keys(self, parent_ud: Any, ud: UserData) -> None:
        _copy(self.get_registered_input_keys(), parent_ud, ud, "input")

    def _copy_output_keys(self, ud: UserData, parent_ud: Any) -> None:
        _copy(self.get_registered_output_keys(), ud, parent_ud, "output")

    def _execute_child(self, label: str, state: State, userdata: Any) -> str | None:
        """Execute a state of this container; InvalidUserCodeError if it raises anything."""
        try:
            return state.execute(userdata)
        except InvalidUserCodeError:
            logerr(f"State '{label}' failed to execute.")
            raise
        except Exception:  # code of the user's may raise anything
            raise InvalidUserCodeError(
                f"Could not execute state '{label}' of type '{type(state).__name__}': {traceback.format_exc()}"
            ) from None

    def _seen_by(self, state: State, remapping: Mapping[str, str]) -> Remapper:
        """Return the userdata as one of the states sees it."""
        return Remapper(self.userdata, state.get_registered_input_keys(), state.get_registered_output_keys(), remapping)

    def __enter__(self) -> Self:
        self.open()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is None:
            self.close()
        else:
            self._leave()

    @contextmanager
    def opened(self, **kwargs: Any) -> Iterator[Self]:
        """Open the container for construction in a ``with`` block."""
        with self:
            yield self

    def open(self) -> None:
        """Open the container for construction, and lock others out until it is closed."""
        Container._construction_lock.acquire()
        Container._construction_stack.append(self)

    def close(self) -> None:
        """Close the container, and log what is inconsistent in it.

        Raises
        ------
        InvalidStateError
            When another container was opened last.
        """
        if not self.is_opened():
            raise InvalidStateError("Attempting to close a container that is not currently open.")
        self._leave()
        try:
            self.check_consistency()
        except (InvalidStateError, InvalidTransitionError):
            logerr("Container consistency check failed.")

    def _leave(self) -> None:
        Container._construction_stack.pop()
        Container._construction_lock.release()

    def is_opened(self) -> bool:
        """Return whether the container was opened last."""
        return bool(Container._construction_stack) and Container._construction_stack[-1] is self

    def assert_opened(self, msg: str = "") -> None:
        """Raise InvalidConstructionError unless the container was opened last."""
        if not self.is_opened():
            raise InvalidConstructionError(msg)

    @classmethod
    def _currently_opened_container(cls) -> Self:
        """Return the container that was opened last, which must be of this class."""
        if not Container._construction_stack:
            raise InvalidStateError("Attempting to access the currently opened container, but no container is opened.")
        opened = Container._construction_stack[-1]
        if not isinstance(opened, cls):
            raise InvalidStateError(
                f"Attempting to call a {cls.__name__} construction method without having opened a {cls.__name__}."
            )
        return opened


def _copy(keys: Iterable[str], source: Any, target: Any, what: str) -> None:
    if source is None or target is None:
        return
    for key in keys:
        if key in source or isinstance(source, Remapper):
            try:
                target[key] = source[key]
                continue
            except KeyError:
                pass
        logwarn(f"Attempting to copy {what} key '{key}', but this key does not exist.")
