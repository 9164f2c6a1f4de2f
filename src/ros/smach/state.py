"""States: what is done, with which outcomes and which data."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from smach.util import has_smach_interface


class State:
    """Base of states.

    Parameters
    ----------
    outcomes
        What `execute` can return.
    input_keys, output_keys
        Userdata that it reads and writes.
    io_keys
        Userdata that it both reads and writes.
    """

    def __init__(
        self,
        outcomes: Iterable[str] = (),
        input_keys: Iterable[str] = (),
        output_keys: Iterable[str] = (),
        io_keys: Iterable[str] = (),
    ) -> None:
        both = set(io_keys)
        self._outcomes = set(outcomes)
        self._input_keys = set(input_keys) | both
        self._output_keys = set(output_keys) | both
        self._preempt_requested = False

    def execute(self, ud: Any) -> str | None:
        """Do what the state is for, and return the outcome; `ud` is the userdata."""
        raise NotImplementedError

    def register_outcomes(self, new_outcomes: Iterable[str]) -> None:
        """Add outcomes."""
        self._outcomes |= set(new_outcomes)

    def get_registered_outcomes(self) -> tuple[str, ...]:
        """Return the outcomes."""
        return tuple(self._outcomes)

    def register_io_keys(self, keys: Iterable[str]) -> None:
        """Add userdata that the state both reads and writes."""
        self.register_input_keys(keys)
        self.register_output_keys(keys)

    def register_input_keys(self, keys: Iterable[str]) -> None:
        """Add userdata that the state reads."""
        self._input_keys |= set(keys)

    def get_registered_input_keys(self) -> tuple[str, ...]:
        """Return the userdata that the state reads."""
        return tuple(self._input_keys)

    def register_output_keys(self, keys: Iterable[str]) -> None:
        """Add userdata that the state writes."""
        self._output_keys |= set(keys)

    def get_registered_output_keys(self) -> tuple[str, ...]:
        """Return the userdata that the state writes."""
        return tuple(self._output_keys)

    def request_preempt(self) -> None:
        """Request that the state ends; `execute` checks `preempt_requested` and calls `service_preempt`."""
        self._preempt_requested = True

    def service_preempt(self) -> None:
        """Confirm that the state ends on request."""
        self._preempt_requested = False

    def recall_preempt(self) -> None:
        """Withdraw the request that the state ends."""
        self._preempt_requested = False

    def preempt_requested(self) -> bool:
        """Return whether the state is requested to end."""
        return self._preempt_requested


class CBState(State):
    """State that calls a function with the userdata and returns its result as the outcome.

    Parameters
    ----------
    cb
        The function; what `smach.cb_interface` declares of it is added to the state.
    cb_args, cb_kwargs
        Further arguments of it.
    outcomes, input_keys, output_keys, io_keys
        See `State`.
    """

    def __init__(
        self,
        cb: Callable[..., Any],
        cb_args: Sequence[Any] = (),
        cb_kwargs: Mapping[str, Any] | None = None,
        outcomes: Iterable[str] = (),
        input_keys: Iterable[str] = (),
        output_keys: Iterable[str] = (),
        io_keys: Iterable[str] = (),
    ) -> None:
        super().__init__(outcomes, input_keys, output_keys, io_keys)
        self._cb = cb
        self._cb_args = cb_args
        self._cb_kwargs = cb_kwargs or {}
        declared: Any = cb
        if has_smach_interface(declared):
            self.register_input_keys(declared.get_registered_input_keys())
            self.register_output_keys(declared.get_registered_output_keys())
            self.register_outcomes(declared.get_registered_outcomes())

    def execute(self, ud: Any) -> str | None:
        """Call the function."""
        outcome: str | None = self._cb(ud, *self._cb_args, **self._cb_kwargs)
        return outcome
