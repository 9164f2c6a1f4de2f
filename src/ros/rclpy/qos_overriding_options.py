"""Quality of service that users may override by parameters, such as ``qos_overrides./scan.subscription.depth``."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from rcl_interfaces.msg import SetParametersResult

from rclpy.duration import Duration
from rclpy.exceptions import ParameterAlreadyDeclaredException
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPolicyEnum,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
)
from rclpy.subscription import Subscription

if TYPE_CHECKING:
    from rclpy.impl.node_parameters import NodeParameters

QosCallbackResult = SetParametersResult
QosCallback = Callable[[QoSProfile], Any]

_ENUMS: dict[QoSPolicyKind, type[QoSPolicyEnum]] = {
    QoSPolicyKind.DURABILITY: DurabilityPolicy,
    QoSPolicyKind.HISTORY: HistoryPolicy,
    QoSPolicyKind.LIVELINESS: LivelinessPolicy,
    QoSPolicyKind.RELIABILITY: ReliabilityPolicy,
}
_DURATIONS = (QoSPolicyKind.DEADLINE, QoSPolicyKind.LIFESPAN, QoSPolicyKind.LIVELINESS_LEASE_DURATION)


class InvalidQosOverridesError(Exception):
    """A parameter holds no value for its policy, or the entity's callback refuses the profile."""


class QoSOverridingOptions:
    """Policies of a publisher or subscription that parameters may override.

    Parameters
    ----------
    policy_kinds
        The policies.
    callback
        ``callback(profile) -> SetParametersResult``: may refuse the resulting profile.
    entity_id
        Tells several entities of a node on one topic apart: ``publisher_<entity_id>``.
    """

    def __init__(
        self,
        policy_kinds: Iterable[QoSPolicyKind],
        *,
        callback: QosCallback | None = None,
        entity_id: str | None = None,
    ) -> None:
        self._policy_kinds = tuple(policy_kinds)
        self._callback = callback
        self._entity_id = entity_id

    @property
    def policy_kinds(self) -> tuple[QoSPolicyKind, ...]:
        """The policies."""
        return self._policy_kinds

    @property
    def callback(self) -> QosCallback | None:
        """What may refuse the profile."""
        return self._callback

    @property
    def entity_id(self) -> str | None:
        """The text that distinguishes entities of one topic."""
        return self._entity_id

    @classmethod
    def with_default_policies(
        cls, *, callback: QosCallback | None = None, entity_id: str | None = None
    ) -> QoSOverridingOptions:
        """Return options for history, depth and reliability."""
        kinds = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)
        return cls(kinds, callback=callback, entity_id=entity_id)


def _declare_qos_parameters(
    entity_type: type[Publisher] | type[Subscription],
    node: NodeParameters,
    topic_name: str,
    qos: QoSProfile,
    options: QoSOverridingOptions,
) -> QoSProfile:
    """Declare the parameters that may override a profile, and return the profile that results.

    Raises
    ------
    InvalidQosOverridesError
        When a parameter's value cannot be used, or the callback refuses the profile.
    """
    kind = "publisher" if issubclass(entity_type, Publisher) else "subscription"
    entity = f"{kind}_{options.entity_id}" if options.entity_id else kind
    result = copy.copy(qos)
    for policy in options.policy_kinds:
        if policy is QoSPolicyKind.LIFESPAN and kind == "subscription":
            continue  # only publishers have one
        field = policy.name.lower()
        name = f"qos_overrides.{topic_name}.{entity}.{field}"
        parameter = _declared(node, name, _get_qos_policy_parameter(qos, policy))
        try:
            setattr(result, field, _from_parameter(policy, parameter.value))
        except (KeyError, ValueError, AssertionError) as error:
            raise InvalidQosOverridesError(f"parameter '{name}' is {parameter.value!r}: {error}") from None
    if options.callback is not None:
        answer = options.callback(result)
        if not getattr(answer, "successful", answer):
            raise InvalidQosOverridesError(
                f"the profile of {kind} '{topic_name}' was refused: {getattr(answer, 'reason', '')}"
            )
    return result


_declare_qos_parameteres = _declare_qos_parameters  # so misspelt by earlier distributions of rclpy


def _declared(node: NodeParameters, name: str, value: Any) -> Parameter[Any]:
    from rcl_interfaces.msg import ParameterDescriptor

    try:
        return node.declare_parameter(name, value, ParameterDescriptor(read_only=True))
    except ParameterAlreadyDeclaredException:
        return node.get_parameter(name)


def _get_qos_policy_parameter(qos: QoSProfile, policy: QoSPolicyKind) -> Any:
    """Return a policy of a profile as the value of a parameter."""
    value = getattr(qos, policy.name.lower())
    if policy in _ENUMS:
        return value.short_key
    return value.nanoseconds if policy in _DURATIONS else value


def _from_parameter(policy: QoSPolicyKind, value: Any) -> Any:
    if policy in _ENUMS:
        return _ENUMS[policy][value.upper()]
    return Duration(nanoseconds=value) if policy in _DURATIONS else value
