"""Types of fields, as `SLOT_TYPES` of messages has them, and the content of interface files."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeVar

Element = TypeVar("Element")

BOOLEAN_TYPE = "boolean"
OCTET_TYPE = "octet"
CHARACTER_TYPES = ("char", "wchar")
SIGNED_NONEXPLICIT_INTEGER_TYPES = ("short", "long", "long long")
UNSIGNED_NONEXPLICIT_INTEGER_TYPES = ("unsigned short", "unsigned long", "unsigned long long")
SIGNED_EXPLICIT_INTEGER_TYPES = ("int8", "int16", "int32", "int64")
UNSIGNED_EXPLICIT_INTEGER_TYPES = ("uint8", "uint16", "uint32", "uint64")
EXPLICIT_INTEGER_TYPES = (*SIGNED_EXPLICIT_INTEGER_TYPES, *UNSIGNED_EXPLICIT_INTEGER_TYPES)
NONEXPLICIT_INTEGER_TYPES = (*SIGNED_NONEXPLICIT_INTEGER_TYPES, *UNSIGNED_NONEXPLICIT_INTEGER_TYPES)
SIGNED_INTEGER_TYPES = (*SIGNED_NONEXPLICIT_INTEGER_TYPES, *SIGNED_EXPLICIT_INTEGER_TYPES)
UNSIGNED_INTEGER_TYPES = (*UNSIGNED_NONEXPLICIT_INTEGER_TYPES, *UNSIGNED_EXPLICIT_INTEGER_TYPES)
INTEGER_TYPES = (*SIGNED_INTEGER_TYPES, *UNSIGNED_INTEGER_TYPES)
FLOATING_POINT_TYPES = ("float", "double", "long double")
BASIC_TYPES = (*INTEGER_TYPES, *FLOATING_POINT_TYPES, *CHARACTER_TYPES, BOOLEAN_TYPE, OCTET_TYPE)

EMPTY_STRUCTURE_REQUIRED_MEMBER_NAME = "structure_needs_at_least_one_member"
CONSTANT_MODULE_SUFFIX = "_Constants"
SERVICE_REQUEST_MESSAGE_SUFFIX = "_Request"
SERVICE_RESPONSE_MESSAGE_SUFFIX = "_Response"
SERVICE_EVENT_MESSAGE_SUFFIX = "_Event"
ACTION_GOAL_SUFFIX = "_Goal"
ACTION_RESULT_SUFFIX = "_Result"
ACTION_FEEDBACK_SUFFIX = "_Feedback"
ACTION_GOAL_SERVICE_SUFFIX = "_SendGoal"
ACTION_RESULT_SERVICE_SUFFIX = "_GetResult"
ACTION_FEEDBACK_MESSAGE_SUFFIX = "_FeedbackMessage"

_BASIC_NAMES = {"bool": "boolean", "byte": "octet", "char": "uint8", "float32": "float", "float64": "double"}


class AbstractType:
    """Base of all types: equal when class and attributes are."""

    __slots__ = ()

    def _key(self) -> tuple[Any, ...]:
        return tuple(getattr(self, name) for kind in type(self).__mro__ for name in getattr(kind, "__slots__", ()))

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash((type(self), self._key()))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(map(repr, self._key()))})"


class AbstractNestableType(AbstractType):
    """Base of the types that arrays and sequences can hold."""

    __slots__ = ()


class BasicType(AbstractNestableType):
    """A number, a boolean or an octet."""

    __slots__ = ("typename",)

    def __init__(self, typename: str) -> None:
        self.typename = typename


class AbstractGenericString(AbstractNestableType):
    """Base of all strings."""

    __slots__ = ()

    def has_maximum_size(self) -> bool:
        """Return whether the string is bounded."""
        return hasattr(self, "maximum_size")


class AbstractString(AbstractGenericString):
    """Base of strings of 8-bit characters."""

    __slots__ = ()


class AbstractWString(AbstractGenericString):
    """Base of strings of wide characters."""

    __slots__ = ()


class BoundedString(AbstractString):
    """A string of at most `maximum_size` characters."""

    __slots__ = ("maximum_size",)

    def __init__(self, maximum_size: int) -> None:
        self.maximum_size = maximum_size


class UnboundedString(AbstractString):
    """A string of any length."""

    __slots__ = ()


class BoundedWString(AbstractWString):
    """A wide string of at most `maximum_size` characters."""

    __slots__ = ("maximum_size",)

    def __init__(self, maximum_size: int) -> None:
        self.maximum_size = maximum_size


class UnboundedWString(AbstractWString):
    """A wide string of any length."""

    __slots__ = ()


class NamedType(AbstractNestableType):
    """A type known by its name."""

    __slots__ = ("name",)

    def __init__(self, name: str) -> None:
        self.name = name


class NamespacedType(AbstractNestableType):
    """A message: `namespaces` such as ['geometry_msgs', 'msg'] and `name` such as 'Point'."""

    __slots__ = ("name", "namespaces")

    def __init__(self, namespaces: list[str], name: str) -> None:
        self.namespaces = namespaces
        self.name = name

    def _key(self) -> tuple[Any, ...]:
        return (tuple(self.namespaces), self.name)

    def namespaced_name(self) -> tuple[str, ...]:
        """Return namespaces and name as one tuple."""
        return (*self.namespaces, self.name)


class AbstractNestedType(AbstractType):
    """Base of arrays and sequences of `value_type`."""

    __slots__ = ("value_type",)

    def __init__(self, value_type: AbstractNestableType) -> None:
        self.value_type = value_type

    def has_maximum_size(self) -> bool:
        """Return whether the number of values is limited."""
        return hasattr(self, "maximum_size") or hasattr(self, "size")


class Array(AbstractNestedType):
    """Exactly `size` values."""

    __slots__ = ("size",)

    def __init__(self, value_type: AbstractNestableType, size: int) -> None:
        super().__init__(value_type)
        self.size = size


class AbstractSequence(AbstractNestedType):
    """Base of sequences."""

    __slots__ = ()


class BoundedSequence(AbstractSequence):
    """At most `maximum_size` values."""

    __slots__ = ("maximum_size",)

    def __init__(self, value_type: AbstractNestableType, maximum_size: int) -> None:
        super().__init__(value_type)
        self.maximum_size = maximum_size


class UnboundedSequence(AbstractSequence):
    """Any number of values."""

    __slots__ = ()


class Annotation:
    """Annotation: its `name`, and its `value`, a dictionary of several or None of none."""

    __slots__ = ("name", "value")

    def __init__(self, name: str, value: Any) -> None:
        self.name = name
        self.value = value


class Annotatable:
    """Base of what can have `annotations`."""

    def __init__(self) -> None:
        self.annotations: list[Annotation] = []

    def get_annotation_values(self, name: str) -> list[Any]:
        """Return the values of the annotations of a name."""
        return [one.value for one in self.annotations if one.name == name]

    def get_annotation_value(self, name: str) -> Any:
        """Return the value of the only annotation of a name; raises ValueError unless there is one."""
        values = self.get_annotation_values(name)
        if len(values) != 1:
            raise ValueError(f"{'Multiple' if values else 'No'} '{name}' annotation{'s' if values else ''}")
        return values[0]

    def has_annotation(self, name: str) -> bool:
        """Return whether there is exactly one annotation of a name."""
        return len(self.get_annotation_values(name)) == 1

    def has_annotations(self, name: str) -> bool:
        """Return whether there are annotations of a name."""
        return bool(self.get_annotation_values(name))

    def get_comment_lines(self) -> list[str]:
        """Return the lines of the comments."""
        values = self.get_annotation_values("verbatim")
        comments = [one for one in values if isinstance(one, dict) and one.get("language") == "comment"]
        return [line for one in comments for line in str(one.get("text", "")).splitlines()]


class Member(Annotatable):
    """Field of a structure."""

    def __init__(self, type_: AbstractType, name: str) -> None:
        super().__init__()
        self.type = type_
        self.name = name


class Structure(Annotatable):
    """Structure of fields, `members`."""

    def __init__(self, namespaced_type: NamespacedType, members: Iterable[Member] = ()) -> None:
        super().__init__()
        self.namespaced_type = namespaced_type
        self.members = list(members)

    def has_any_member_with_annotation(self, name: str) -> bool:
        """Return whether a field has an annotation of a name."""
        return any(member.has_annotation(name) for member in self.members)


class Include:
    """Path of another interface file."""

    __slots__ = ("locator",)

    def __init__(self, locator: str) -> None:
        self.locator = locator


class Constant(Annotatable):
    """Named value."""

    def __init__(self, name: str, type_: AbstractType, value: Any) -> None:
        super().__init__()
        self.name = name
        self.type = type_
        self.value = value


class Message:
    """Message: its `structure` and its `constants`."""

    __slots__ = ("constants", "structure")

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.constants: list[Constant] = []


class Service:
    """Service: its messages, that of service introspection included."""

    __slots__ = ("event_message", "namespaced_type", "request_message", "response_message")

    def __init__(self, namespaced_type: NamespacedType, request: Message, response: Message) -> None:
        self.namespaced_type = namespaced_type
        self.request_message = request
        self.response_message = response
        one = (BoundedSequence(each.structure.namespaced_type, 1) for each in (request, response))
        self.event_message = _message(
            namespaced_type,
            SERVICE_EVENT_MESSAGE_SUFFIX,
            Member(NamespacedType(["service_msgs", "msg"], "ServiceEventInfo"), "info"),
            Member(next(one), "request"),
            Member(next(one), "response"),
        )


class Action:
    """Action: its messages, and the services and the message of the feedback topic that are made of them."""

    __slots__ = (
        "feedback",
        "feedback_message",
        "get_result_service",
        "goal",
        "implicit_includes",
        "namespaced_type",
        "result",
        "send_goal_service",
    )

    def __init__(self, namespaced_type: NamespacedType, goal: Message, result: Message, feedback: Message) -> None:
        self.namespaced_type = namespaced_type
        self.goal = goal
        self.result = result
        self.feedback = feedback
        self.implicit_includes = [
            Include("builtin_interfaces/msg/Time.idl"),
            Include("unique_identifier_msgs/msg/UUID.idl"),
        ]
        goal_id = Member(NamespacedType(["unique_identifier_msgs", "msg"], "UUID"), "goal_id")
        self.send_goal_service = _service(
            namespaced_type,
            ACTION_GOAL_SERVICE_SUFFIX,
            [goal_id, Member(goal.structure.namespaced_type, "goal")],
            [
                Member(BasicType(BOOLEAN_TYPE), "accepted"),
                Member(NamespacedType(["builtin_interfaces", "msg"], "Time"), "stamp"),
            ],
        )
        self.get_result_service = _service(
            namespaced_type,
            ACTION_RESULT_SERVICE_SUFFIX,
            [goal_id],
            [Member(BasicType("int8"), "status"), Member(result.structure.namespaced_type, "result")],
        )
        self.feedback_message = _message(
            namespaced_type,
            ACTION_FEEDBACK_MESSAGE_SUFFIX,
            goal_id,
            Member(feedback.structure.namespaced_type, "feedback"),
        )


def _message(base: NamespacedType, suffix: str, *members: Member) -> Message:
    return Message(Structure(NamespacedType(base.namespaces, f"{base.name}{suffix}"), members))


def _service(base: NamespacedType, suffix: str, request: list[Member], response: list[Member]) -> Service:
    whole = NamespacedType(base.namespaces, f"{base.name}{suffix}")
    return Service(
        whole,
        _message(whole, SERVICE_REQUEST_MESSAGE_SUFFIX, *request),
        _message(whole, SERVICE_RESPONSE_MESSAGE_SUFFIX, *response),
    )


class IdlLocator:
    """Path of an interface file: a folder and the path from there."""

    __slots__ = ("basepath", "relative_path")

    def __init__(self, basepath: Path, relative_path: Path) -> None:
        self.basepath = basepath
        self.relative_path = relative_path

    def get_absolute_path(self) -> Path:
        """Return the path of the file."""
        return self.basepath / self.relative_path


class IdlContent:
    """Content of an interface file: its `elements`."""

    __slots__ = ("elements",)

    def __init__(self) -> None:
        self.elements: list[Any] = []

    def get_elements_of_type(self, type_: type[Element]) -> list[Element]:
        """Return the elements of a class."""
        return [one for one in self.elements if isinstance(one, type_)]


class IdlFile:
    """Interface file: where it is and its content."""

    __slots__ = ("content", "locator")

    def __init__(self, locator: IdlLocator, content: IdlContent) -> None:
        self.locator = locator
        self.content = content


def slot_types(message_type: Any) -> tuple[AbstractType, ...]:
    """Describe the fields of a generated message class, in their order."""
    return tuple(_slot_type(base, kind, size, bound) for _, base, kind, size, bound in message_type._FIELDS)


def _slot_type(base: Any, kind: str, size: int, bound: int | None) -> AbstractType:
    one: AbstractNestableType
    if not isinstance(base, str):
        package, folder, name = base._TYPE_NAME.split("/")
        one = NamespacedType([package, folder], name)
    elif base == "string":
        one = UnboundedString() if bound is None else BoundedString(bound)
    elif base == "wstring":
        one = UnboundedWString() if bound is None else BoundedWString(bound)
    else:
        one = BasicType(_BASIC_NAMES.get(base, base))
    if kind == "array":
        return Array(one, size)
    if kind == "bounded":
        return BoundedSequence(one, size)
    return UnboundedSequence(one) if kind == "unbounded" else one
