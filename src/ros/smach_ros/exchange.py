"""Messages that are filled from userdata, and userdata that are filled from messages."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import smach
from rclpy.node import Node

from smach_ros.ros_state import RosState


class ExchangeState(RosState):
    """Base of states that send a message and receive another: a service call or an action.

    Parameters
    ----------
    node
        See `RosState`.
    outcomes, input_keys, output_keys
        See `smach.State`.
    """

    def __init__(
        self, node: Node, outcomes: Iterable[str], input_keys: Iterable[str], output_keys: Iterable[str]
    ) -> None:
        super().__init__(node, outcomes=outcomes, input_keys=input_keys, output_keys=output_keys)


class Part:
    """What one of the two messages of an `ExchangeState` has to do with userdata.

    Parameters
    ----------
    state
        The state, which gets the keys of this part.
    what
        ``goal``, ``request``, ``result`` or ``response``, for messages to the user.
    message_type
        The class of the message.
    key
        Userdata with the whole message; None: there is none.
    slots
        Userdata with fields of the message, under their names.
    callback, args, keywords
        A function of the user's, called with the userdata and more, and its further arguments.
    is_input
        Whether the message is filled from userdata; else userdata are filled from it.

    Raises
    ------
    smach.InvalidStateError
        When the message does not have the fields, or the callback cannot be called.
    """

    def __init__(
        self,
        state: ExchangeState,
        what: str,
        message_type: Any,
        *,
        key: str | None,
        slots: Sequence[str],
        callback: Callable[..., Any] | None,
        args: Sequence[Any],
        keywords: Mapping[str, Any] | None,
        is_input: bool,
    ) -> None:
        fields = message_type.get_fields_and_field_types()
        unknown = [slot for slot in slots if slot not in fields]
        if unknown:
            raise smach.InvalidStateError(f"The {what} has no fields {unknown}; it has {list(fields)}")
        if callback is not None and not callable(callback):
            raise smach.InvalidStateError(f"The {what} callback {callback!r} is not a function")
        self._state = state
        self._what = what
        self._key = key
        self._slots = list(slots)
        self._callback = callback
        self._args = args
        self._keywords = keywords or {}
        given: Any = callback
        declared: Any = given if smach.has_smach_interface(given) else state
        self._declared = declared
        keys = [*self._slots, *([key] if key is not None else [])]
        (state.register_input_keys if is_input else state.register_output_keys)(keys)
        if declared is given:
            state.register_input_keys(declared.get_registered_input_keys())
            state.register_output_keys(declared.get_registered_output_keys())
            state.register_outcomes(declared.get_registered_outcomes())

    def fill(self, ud: Any, message: Any) -> Any:
        """Return the message filled from userdata; None, with a message logged, where that is not possible."""
        for key in [*([self._key] if self._key is not None else []), *self._slots]:
            if key not in ud:
                self._fail(f"the userdata have no '{key}', only {ud.keys()}")
                return None
        if self._key is not None:
            message = _plain(ud[self._key])
        for slot in self._slots:
            setattr(message, slot, _plain(ud[slot]))
        done, returned = self._call(ud, message)
        if not done:
            return None
        return message if returned is None else returned

    def store(self, ud: Any, message: Any, *more: Any) -> tuple[bool, str | None]:
        """Fill userdata from a message; return whether that was possible, and the callback's outcome.

        Parameters
        ----------
        ud
            The userdata.
        message
            The message.
        more
            Arguments of the callback between the two.
        """
        done, outcome = self._call(ud, *more, message)
        if not done:
            return False, None
        if outcome is not None and outcome not in self._state.get_registered_outcomes():
            self._fail(f"the callback returned '{outcome}', which is not an outcome of the state")
            return False, None
        if self._key is not None:
            ud[self._key] = message
        for slot in self._slots:
            ud[slot] = getattr(message, slot)
        return True, outcome

    def _call(self, ud: Any, *arguments: Any) -> tuple[bool, Any]:
        if self._callback is None:
            return True, None
        declared = self._declared
        seen = smach.Remapper(ud, declared.get_registered_input_keys(), declared.get_registered_output_keys())
        try:
            return True, self._callback(seen, *arguments, *self._args, **self._keywords)
        except Exception:  # code of the user's may raise anything
            self._fail(f"the callback failed: {traceback.format_exc()}")
            return False, None

    def _fail(self, why: str) -> None:
        self._state.node.get_logger().error(f"Could not handle the {self._what}: {why}")


def _plain(value: Any) -> Any:
    """Return an object out of userdata that may only be read."""
    return vars(value)["_obj"] if isinstance(value, smach.Const) else value
