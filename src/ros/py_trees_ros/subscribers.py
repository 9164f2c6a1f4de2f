"""Behaviours that subscribe."""

from __future__ import annotations

import operator
import threading
from collections.abc import Callable, Mapping
from typing import Any

import py_trees
from py_trees.common import Access, ClearingPolicy, Status
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Empty

from py_trees_ros.publishers import node_of


class Handler(py_trees.behaviour.Behaviour):  # type: ignore[misc]
    """Base of behaviours with a subscription, whose last message is `msg`.

    Parameters
    ----------
    name
        Name of the behaviour.
    topic_name, topic_type, qos_profile
        The topic, the class of its messages and the quality of service.
    clearing_policy
        When to forget the last message.
    """

    def __init__(
        self,
        name: str,
        topic_name: str,
        topic_type: Any,
        qos_profile: QoSProfile,
        clearing_policy: ClearingPolicy = ClearingPolicy.ON_INITIALISE,
    ) -> None:
        super().__init__(name=name)
        self.topic_name = topic_name
        self.topic_type = topic_type
        self.qos_profile = qos_profile
        self.clearing_policy = clearing_policy
        self.msg: Any = None
        self.subscriber: Any = None
        self.data_guard = threading.Lock()
        self.node: Node | None = None

    def setup(self, **kwargs: Any) -> None:
        """Create the subscription on the given ``node``."""
        self.node = node_of(self, kwargs)
        self.subscriber = self.node.create_subscription(
            self.topic_type, self.topic_name, self._callback, self.qos_profile
        )

    def initialise(self) -> None:
        """Forget the last message, if the policy says so."""
        with self.data_guard:
            if self.clearing_policy == ClearingPolicy.ON_INITIALISE:
                self.msg = None

    def _callback(self, message: Any) -> None:
        with self.data_guard:
            self.msg = message

    def _taken(self) -> Any:
        """Return the last message, None without one, and forget it, if the policy says so."""
        with self.data_guard:
            message = self.msg
            if self.clearing_policy == ClearingPolicy.ON_SUCCESS:
                self.msg = None
        return message


class CheckData(Handler):
    """Behaviour that compares a field of the last message with a value.

    Parameters
    ----------
    name, topic_name, topic_type, qos_profile, clearing_policy
        See `Handler`.
    variable_name
        The field; may be nested, such as ``pose.position.x``.
    expected_value
        The value.
    comparison_operator
        Called with the field and the value.
    fail_if_no_data
        Whether to fail, instead of to be running, as long as there is no message.
    fail_if_bad_comparison
        Whether to fail, instead of to be running, when the comparison is false.
    """

    def __init__(
        self,
        name: str,
        topic_name: str,
        topic_type: Any,
        qos_profile: QoSProfile,
        variable_name: str,
        expected_value: Any,
        comparison_operator: Callable[[Any, Any], Any] = operator.eq,
        fail_if_no_data: bool = False,
        fail_if_bad_comparison: bool = False,
        clearing_policy: ClearingPolicy = ClearingPolicy.ON_INITIALISE,
    ) -> None:
        super().__init__(name, topic_name, topic_type, qos_profile, clearing_policy)
        self.variable_name = variable_name
        self.expected_value = expected_value
        self.comparison_operator = comparison_operator
        self.fail_if_no_data = fail_if_no_data
        self.fail_if_bad_comparison = fail_if_bad_comparison

    def update(self) -> Status:
        """Compare."""
        with self.data_guard:
            message = self.msg
        if message is None:
            self.feedback_message = "no message received yet"
            return Status.FAILURE if self.fail_if_no_data else Status.RUNNING
        try:
            value = operator.attrgetter(self.variable_name)(message)
        except AttributeError:
            self.feedback_message = f"variable name not found [{self.variable_name}]"
            return Status.FAILURE
        if self.comparison_operator(value, self.expected_value):
            self.feedback_message = (
                f"'{self.variable_name}' comparison succeeded [v: {value}][e: {self.expected_value}]"
            )
            self._taken()
            return Status.SUCCESS
        self.feedback_message = f"'{self.variable_name}' comparison failed [v: {value}][e: {self.expected_value}]"
        return Status.FAILURE if self.fail_if_bad_comparison else Status.RUNNING


class WaitForData(Handler):
    """Behaviour that succeeds when there is a message."""

    def update(self) -> Status:
        """Check for a message."""
        if self._taken() is None:
            self.feedback_message = "no message received yet"
            return Status.RUNNING
        self.feedback_message = "got incoming"
        return Status.SUCCESS


class ToBlackboard(Handler):
    """Behaviour that stores the last message, or fields of it, on the blackboard.

    Parameters
    ----------
    name, topic_name, topic_type, qos_profile, clearing_policy
        See `Handler`.
    blackboard_variables
        Fields of the message by variable; None is the whole message. A string alone is the variable for it.
    initialise_variables
        Values of variables before the first message.
    """

    def __init__(
        self,
        name: str,
        topic_name: str,
        topic_type: Any,
        qos_profile: QoSProfile,
        blackboard_variables: str | Mapping[str, str | None] | None = None,
        initialise_variables: Mapping[str, Any] | None = None,
        clearing_policy: ClearingPolicy = ClearingPolicy.ON_INITIALISE,
    ) -> None:
        super().__init__(name, topic_name, topic_type, qos_profile, clearing_policy)
        self.blackboard = self.attach_blackboard_client(name=self.name)
        if isinstance(blackboard_variables, str):
            blackboard_variables = {blackboard_variables: None}
        self.blackboard_variable_mapping = dict(blackboard_variables or {})
        for variable in self.blackboard_variable_mapping:
            self.blackboard.register_key(key=variable.split(".")[0], access=Access.WRITE)
        for variable, value in (initialise_variables or {}).items():
            self.blackboard.register_key(key=variable.split(".")[0], access=Access.WRITE)
            self.blackboard.set(variable, value)

    def update(self) -> Status:
        """Store the message."""
        message = self._taken()
        if message is None:
            self.feedback_message = "no message received yet"
            return Status.RUNNING
        for variable, field in self.blackboard_variable_mapping.items():
            value = message if field is None else operator.attrgetter(field)(message)
            self.blackboard.set(variable, value, overwrite=True)
        self.feedback_message = "saved incoming message"
        return Status.SUCCESS


class EventToBlackboard(Handler):
    """Behaviour that stores whether there was an event, an empty message, since the last tick; always SUCCESS.

    Parameters
    ----------
    name, topic_name, qos_profile
        See `Handler`.
    variable_name
        The variable of the blackboard, True or False.
    """

    def __init__(self, name: str, topic_name: str, qos_profile: QoSProfile, variable_name: str) -> None:
        super().__init__(name, topic_name, Empty, qos_profile, ClearingPolicy.ON_SUCCESS)
        self.variable_name = variable_name
        self.blackboard = self.attach_blackboard_client(name=self.name)
        self.blackboard.register_key(key=variable_name, access=Access.WRITE)

    def update(self) -> Status:
        """Store whether there was an event."""
        happened = self._taken() is not None
        self.blackboard.set(self.variable_name, happened)
        self.feedback_message = "event triggered" if happened else "no event"
        return Status.SUCCESS
