"""Behaviours, their types and states as messages."""

from __future__ import annotations

import uuid
from typing import Any

import py_trees
from py_trees.common import BlackBoxLevel, Status
from py_trees_ros_interfaces.msg import ActivityItem, Behaviour, KeyValue
from rclpy.duration import Duration
from rclpy.time import Time
from unique_identifier_msgs.msg import UUID

_TYPES: dict[int, type] = {
    Behaviour.SEQUENCE: py_trees.composites.Sequence,
    Behaviour.SELECTOR: py_trees.composites.Selector,
    Behaviour.PARALLEL: py_trees.composites.Parallel,
    Behaviour.DECORATOR: py_trees.decorators.Decorator,
    Behaviour.BEHAVIOUR: py_trees.behaviour.Behaviour,
}
"""Classes by type in messages, the base of all last."""

_STATUSES = {
    Status.INVALID: Behaviour.INVALID,
    Status.RUNNING: Behaviour.RUNNING,
    Status.SUCCESS: Behaviour.SUCCESS,
    Status.FAILURE: Behaviour.FAILURE,
}
_LEVELS = {
    BlackBoxLevel.DETAIL: Behaviour.BLACKBOX_LEVEL_DETAIL,
    BlackBoxLevel.COMPONENT: Behaviour.BLACKBOX_LEVEL_COMPONENT,
    BlackBoxLevel.BIG_PICTURE: Behaviour.BLACKBOX_LEVEL_BIG_PICTURE,
    BlackBoxLevel.NOT_A_BLACKBOX: Behaviour.BLACKBOX_LEVEL_NOT_A_BLACKBOX,
}
_MEMORY = "WithMemory"


def activity_stream_to_msgs() -> list[ActivityItem]:
    """Return what happened on the blackboard since the stream was cleared."""
    stream = py_trees.blackboard.Blackboard.activity_stream
    return [
        ActivityItem(
            key=item.key,
            client_name=item.client_name,
            activity_type=item.activity_type,
            previous_value="" if item.previous_value is None else str(item.previous_value),
            current_value="" if item.current_value is None else str(item.current_value),
        )
        for item in (stream.data if stream is not None else ())
    ]


def behaviour_type_to_msg_constant(behaviour: Any) -> int:
    """Return the type of a behaviour in messages."""
    return next((value for value, kind in _TYPES.items() if isinstance(behaviour, kind)), int(Behaviour.UNKNOWN_TYPE))


def msg_constant_to_behaviour_type(value: int) -> type:
    """Return the class of a type in messages; raises TypeError for an unknown one."""
    if value not in _TYPES:
        raise TypeError(f"invalid type specified in message [{value}]")
    return _TYPES[value]


def additional_detail_to_str(behaviour: Any) -> str:
    """Return the policy of a parallel, or whether another composite has a memory."""
    if isinstance(behaviour, py_trees.composites.Parallel):
        return str(behaviour.policy.__class__.__name__)
    if isinstance(behaviour, py_trees.composites.Sequence | py_trees.composites.Selector):
        return _MEMORY if behaviour.memory else "WithoutMemory"
    return ""


def status_enum_to_msg_constant(status: Status) -> int:
    """Return the status in messages."""
    return int(_STATUSES[status])


def msg_constant_to_status_enum(value: int) -> Status:
    """Return the status of a value in messages; raises TypeError for an unknown one."""
    return _inverse(_STATUSES, value, "status")


def blackbox_enum_to_msg_constant(blackbox_level: BlackBoxLevel) -> int:
    """Return the level of detail in messages."""
    return int(_LEVELS[blackbox_level])


def msg_constant_to_blackbox_level_enum(value: int) -> BlackBoxLevel:
    """Return the level of detail of a value in messages; raises TypeError for an unknown one."""
    return _inverse(_LEVELS, value, "blackbox level")


def _inverse(table: dict[Any, int], value: int, what: str) -> Any:
    for enum, constant in table.items():
        if constant == value:
            return enum
    raise TypeError(f"invalid {what} specified in message [{value}]")


def uuid4_to_msg(uuid4: uuid.UUID | None = None) -> UUID:
    """Return an identifier as a message; a new one where None."""
    return UUID(uuid=list((uuid4 or uuid.uuid4()).bytes))


def msg_to_uuid4(msg: UUID) -> uuid.UUID:
    """Return the identifier of a message."""
    return uuid.UUID(bytes=bytes(bytearray(msg.uuid)), version=4)


def _optional(behaviour: Any) -> UUID:
    return UUID() if behaviour is None else uuid4_to_msg(behaviour.id)


def behaviour_to_msg(behaviour: Any) -> Behaviour:
    """Return a behaviour as a message."""
    return Behaviour(
        name=behaviour.name,
        class_name=f"{behaviour.__module__}.{type(behaviour).__name__}",
        own_id=uuid4_to_msg(behaviour.id),
        parent_id=_optional(behaviour.parent),
        child_ids=[uuid4_to_msg(child.id) for child in behaviour.children],
        current_child_id=_optional(getattr(behaviour, "current_child", None)),
        tip_id=_optional(behaviour.tip()),
        type=behaviour_type_to_msg_constant(behaviour),
        blackbox_level=blackbox_enum_to_msg_constant(behaviour.blackbox_level),
        status=status_enum_to_msg_constant(behaviour.status),
        message=behaviour.feedback_message,
        additional_detail=additional_detail_to_str(behaviour),
        blackboard_access=_access(behaviour),
    )


def _access(behaviour: Any) -> list[KeyValue]:
    found: dict[str, set[str]] = {}
    for client in behaviour.blackboards:
        for keys, mark in (
            (client.read, Behaviour.BLACKBOARD_ACCESS_READ),
            (client.write, Behaviour.BLACKBOARD_ACCESS_WRITE),
            (client.exclusive, Behaviour.BLACKBOARD_ACCESS_EXCLUSIVE_WRITE),
        ):
            for key in keys:
                found.setdefault(key, set()).add(mark)
    return [KeyValue(key=key, value=",".join(sorted(marks))) for key, marks in found.items()]


def msg_to_behaviour(msg: Behaviour) -> Any:
    """Return a behaviour of a message's kind, name and state, for display; without its children."""
    kind = msg_constant_to_behaviour_type(msg.type)
    behaviour: Any
    if kind is py_trees.decorators.Decorator:
        behaviour = py_trees.decorators.PassThrough(name=msg.name, child=py_trees.behaviours.Dummy())
    elif kind in (py_trees.composites.Sequence, py_trees.composites.Selector):
        behaviour = kind(name=msg.name, memory=msg.additional_detail == _MEMORY)
    elif kind is py_trees.composites.Parallel:
        behaviour = kind(name=msg.name, policy=py_trees.common.ParallelPolicy.SuccessOnAll())
    else:
        behaviour = py_trees.behaviours.Dummy(name=msg.name)
    behaviour.id = msg_to_uuid4(msg.own_id)
    behaviour.status = msg_constant_to_status_enum(msg.status)
    behaviour.feedback_message = msg.message
    behaviour.blackbox_level = msg_constant_to_blackbox_level_enum(msg.blackbox_level)
    return behaviour


def rclpy_time_to_float(time: Time) -> float:
    """Return a point in time in seconds."""
    return float(time.nanoseconds) / 1e9


def rclpy_duration_to_float(duration: Duration) -> float:
    """Return a duration in seconds."""
    return float(duration.nanoseconds) / 1e9
