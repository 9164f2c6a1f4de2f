"""Data model of interface files: fields, constants, messages, services and actions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

PRIMITIVES = frozenset(
    {
        "bool", "byte", "char", "float32", "float64",
        "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64",
        "string", "wstring",
    }
)  # fmt: skip

INTEGER_RANGES = {
    "byte": (0, 255),
    "char": (0, 255),
    **{f"int{n}": (-(2 ** (n - 1)), 2 ** (n - 1) - 1) for n in (8, 16, 32, 64)},
    **{f"uint{n}": (0, 2**n - 1) for n in (8, 16, 32, 64)},
}

# How rosidl spells the types in `get_fields_and_field_types()`: IDL's names.
IDL_NAMES = {"bool": "boolean", "byte": "octet", "float32": "float", "float64": "double", "char": "uint8"}


class Kind(Enum):
    """Number of values of a field."""

    SINGLE = "single"
    ARRAY = "array"
    BOUNDED = "bounded"
    UNBOUNDED = "unbounded"


@dataclass(frozen=True)
class FieldType:
    """Type of a field.

    Attributes
    ----------
    base
        A name in `PRIMITIVES`, or a full name such as ``geometry_msgs/msg/Point``.
    kind
        Single value, fixed array, bounded or unbounded sequence.
    size
        Length of an array, or upper bound of a bounded sequence; 0 otherwise.
    string_bound
        Upper bound of a string's length in characters, or None.
    """

    base: str
    kind: Kind = Kind.SINGLE
    size: int = 0
    string_bound: int | None = None

    @property
    def is_primitive(self) -> bool:
        """Return whether the base is a primitive type instead of another interface."""
        return self.base in PRIMITIVES

    def idl(self) -> str:
        """Return the type in rosidl's notation, such as ``sequence<double, 4>``."""
        if self.is_primitive:
            name = IDL_NAMES.get(self.base, self.base)
        else:
            package, _, short = self.base.split("/")
            name = f"{package}/{short}"
        if self.string_bound is not None:
            name += f"<{self.string_bound}>"
        match self.kind:
            case Kind.ARRAY:
                return f"{name}[{self.size}]"
            case Kind.BOUNDED:
                return f"sequence<{name}, {self.size}>"
            case Kind.UNBOUNDED:
                return f"sequence<{name}>"
        return name


Literal = bool | int | float | str | list[bool] | list[int] | list[float] | list[str]


@dataclass(frozen=True)
class Field:
    """Field of a message: type, name, default value and comment."""

    type: FieldType
    name: str
    default: Literal | None = None
    comment: str = ""


@dataclass(frozen=True)
class Constant:
    """Named value of a message."""

    type: FieldType
    name: str
    value: bool | int | float | str
    comment: str = ""


@dataclass(frozen=True)
class Message:
    """Message, or a message that is part of a service or an action."""

    name: str
    fields: tuple[Field, ...] = ()
    constants: tuple[Constant, ...] = ()
    comment: str = ""

    def nested(self) -> Iterator[str]:
        """Yield the full names of the interfaces that the fields refer to."""
        for field in self.fields:
            if not field.type.is_primitive:
                yield field.type.base


@dataclass(frozen=True)
class Service:
    """Service: request and response; `event` is the message of service introspection."""

    name: str
    request: Message
    response: Message

    @property
    def event(self) -> Message:
        """Event message of service introspection."""
        one = Kind.BOUNDED
        return Message(
            f"{self.name}_Event",
            (
                Field(FieldType("service_msgs/msg/ServiceEventInfo"), "info"),
                Field(FieldType(self.request.name, one, 1), "request"),
                Field(FieldType(self.response.name, one, 1), "response"),
            ),
        )

    @property
    def messages(self) -> tuple[Message, Message, Message]:
        """Request, response and event."""
        return self.request, self.response, self.event


@dataclass(frozen=True)
class Action:
    """Action: goal, result and feedback, with the services and the message built from them."""

    name: str
    goal: Message
    result: Message
    feedback: Message

    @property
    def send_goal(self) -> Service:
        """Service by which a client sends a goal."""
        return Service(
            f"{self.name}_SendGoal",
            Message(f"{self.name}_SendGoal_Request", (_GOAL_ID, Field(FieldType(self.goal.name), "goal"))),
            Message(
                f"{self.name}_SendGoal_Response",
                (
                    Field(FieldType("bool"), "accepted"),
                    Field(FieldType("builtin_interfaces/msg/Time"), "stamp"),
                ),
            ),
        )

    @property
    def get_result(self) -> Service:
        """Service by which a client requests the result."""
        return Service(
            f"{self.name}_GetResult",
            Message(f"{self.name}_GetResult_Request", (_GOAL_ID,)),
            Message(
                f"{self.name}_GetResult_Response",
                (Field(FieldType("int8"), "status"), Field(FieldType(self.result.name), "result")),
            ),
        )

    @property
    def feedback_message(self) -> Message:
        """Message on the feedback topic."""
        return Message(f"{self.name}_FeedbackMessage", (_GOAL_ID, Field(FieldType(self.feedback.name), "feedback")))

    @property
    def messages(self) -> tuple[Message, ...]:
        """All messages of the action, including those of its services."""
        return (
            self.goal, self.result, self.feedback,
            *self.send_goal.messages, *self.get_result.messages, self.feedback_message,
        )  # fmt: skip


_GOAL_ID = Field(FieldType("unique_identifier_msgs/msg/UUID"), "goal_id")

Interface = Message | Service | Action


def messages_of(interface: Interface) -> tuple[Message, ...]:
    """Return every message of the interface; the interface itself if it is a message."""
    return (interface,) if isinstance(interface, Message) else interface.messages
