"""Parser of .idl files, which describe interfaces in the Interface Definition Language of the OMG (IDL 4.2).

The subset is that of https://design.ros2.org/articles/idl_interface_definition.html.
"""

from __future__ import annotations

import functools
from typing import Any

from lark import Lark, Token, Tree

from rosidl_parser.definition import (
    ACTION_FEEDBACK_SUFFIX,
    ACTION_GOAL_SUFFIX,
    ACTION_RESULT_SUFFIX,
    CONSTANT_MODULE_SUFFIX,
    SERVICE_REQUEST_MESSAGE_SUFFIX,
    SERVICE_RESPONSE_MESSAGE_SUFFIX,
    AbstractNestableType,
    AbstractNestedType,
    AbstractType,
    Action,
    Annotation,
    Array,
    BasicType,
    BoundedSequence,
    BoundedString,
    BoundedWString,
    Constant,
    IdlContent,
    IdlFile,
    IdlLocator,
    Include,
    Member,
    Message,
    NamedType,
    NamespacedType,
    Service,
    Structure,
    UnboundedSequence,
    UnboundedString,
    UnboundedWString,
)

_BASIC_TYPES = (
    r"long\s+double|(unsigned\s+)?long\s+long|unsigned\s+(short|long)|u?int(8|16|32|64)|"
    r"short|long|float|double|wchar|char|boolean|octet"
)
GRAMMAR = (
    rf"BASIC_TYPE.3: /({_BASIC_TYPES})\b/"
    + r"""
specification: (include_directive | definition)*
include_directive: "#" "include" (QUOTED_PATH | BRACKETED_PATH)
?definition: module_dcl ";" | const_dcl ";" | typedef_dcl ";" | struct_def ";"
module_dcl: annotations "module" IDENTIFIER "{" definition* "}"
const_dcl: annotations "const" type_spec IDENTIFIER "=" const_expr
typedef_dcl: annotations "typedef" type_spec declarator
struct_def: annotations "struct" IDENTIFIER "{" member* "}"
member: annotations type_spec declarator ("," declarator)* ";"
declarator: IDENTIFIER ("[" const_expr "]")*
annotations: annotation*
annotation: "@" scoped_name ["(" (const_expr | annotation_param ("," annotation_param)*) ")"]
annotation_param: IDENTIFIER "=" const_expr

?type_spec: basic_type | string_type | wstring_type | sequence_type | named_type
basic_type: BASIC_TYPE
string_type: "string" ["<" const_expr ">"]
wstring_type: "wstring" ["<" const_expr ">"]
sequence_type: "sequence" "<" type_spec ["," const_expr] ">"
named_type: scoped_name
scoped_name: "::"? IDENTIFIER ("::" IDENTIFIER)*

?const_expr: literal | scoped_name
?literal: number | boolean | string_literals | wide_string_literals | character
number: NUMBER
boolean: BOOLEAN
character: CHARACTER
string_literals: STRING+
wide_string_literals: WIDE_STRING+

BOOLEAN.3: /(TRUE|FALSE)\b/
IDENTIFIER: /[A-Za-z_]\w*/
NUMBER: /[-+]?(0[xX][0-9a-fA-F]+|(\d+\.\d*|\.\d+|\d+)([eE][-+]?\d+)?[dDfF]?)/
STRING: /"(\\.|[^"\\\n])*"/s
WIDE_STRING.3: /L"(\\.|[^"\\\n])*"/s
CHARACTER: /L?'(\\.|[^'\\])+'/
QUOTED_PATH.2: /"[^"\n]+"/
BRACKETED_PATH: /<[^>\n]+>/
%ignore /\s+/
%ignore /\/\/[^\n]*/
%ignore /\/\*(.|\n)*?\*\//
"""
)
_ALIASES = {
    "short": "int16",
    "unsigned short": "uint16",
    "long": "int32",
    "unsigned long": "uint32",
    "long long": "int64",
    "unsigned long long": "uint64",
}


def parse_idl_file(locator: IdlLocator, png_file: str | None = None) -> IdlFile:
    """Return the content of a file.

    Parameters
    ----------
    locator
        The file.
    png_file
        Of no use: the tree is not drawn.

    Raises
    ------
    lark.exceptions.UnexpectedInput, ValueError
        When it is not IDL, or more than the subset; the message begins with the path.
    """
    path = locator.get_absolute_path()
    try:
        return IdlFile(locator, parse_idl_string(path.read_text(encoding="utf-8")))
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    except Exception as error:
        error.add_note(str(path))
        raise


def parse_idl_string(idl_string: str, png_file: str | None = None) -> IdlContent:
    """Return the content of a text; see `parse_idl_file`."""
    return extract_content_from_ast(get_ast_from_idl_string(idl_string))


@functools.cache
def _parser() -> Lark:
    return Lark(GRAMMAR, start="specification", parser="lalr", lexer="contextual", maybe_placeholders=True)


def get_ast_from_idl_string(idl_string: str) -> Tree[Token]:
    """Return the syntax tree of a text."""
    return _parser().parse(idl_string)


def extract_content_from_ast(tree: Tree[Token]) -> IdlContent:
    """Return the content of a syntax tree: includes, and a message, a service or an action.

    Raises
    ------
    ValueError
        When it has other structures than those of one of these.
    """
    content = IdlContent()
    reader = _Reader()
    for child in tree.children:
        assert isinstance(child, Tree)
        if child.data == "include_directive":
            content.elements.append(Include(str(child.children[0])[1:-1]))
        else:
            reader.read(child, [])
    messages = [reader.message(structure) for structure in reader.structures]
    interface = _interface(messages)
    if isinstance(interface, Action):
        known = {one.locator for one in content.get_elements_of_type(Include)}
        content.elements += [one for one in interface.implicit_includes if one.locator not in known]
    content.elements.append(interface)
    return content


def _interface(messages: list[Message]) -> Message | Service | Action:
    suffixes: dict[int, tuple[str, ...]] = {
        1: ("",),
        2: (SERVICE_REQUEST_MESSAGE_SUFFIX, SERVICE_RESPONSE_MESSAGE_SUFFIX),
        3: (ACTION_GOAL_SUFFIX, ACTION_RESULT_SUFFIX, ACTION_FEEDBACK_SUFFIX),
    }
    types = [message.structure.namespaced_type for message in messages]
    expected = suffixes.get(len(messages))
    if expected is None:
        raise ValueError(f"expected 1 structure (a message), 2 (a service) or 3 (an action), found {len(messages)}")
    names = {one.name.removesuffix(suffix) for one, suffix in zip(types, expected, strict=True)}
    if len(names) != 1 or any(not one.name.endswith(suffix) for one, suffix in zip(types, expected, strict=True)):
        found = ", ".join(one.name for one in types)
        raise ValueError(f"expected structures that end with {', '.join(expected)}, found {found}")
    whole = NamespacedType(types[0].namespaces, names.pop())
    if len(messages) == 1:
        return messages[0]
    return Service(whole, *messages) if len(messages) == 2 else Action(whole, *messages)


class _Reader:
    """Reader of syntax trees."""

    def __init__(self) -> None:
        self.structures: list[Structure] = []
        self._constants: dict[str, list[Constant]] = {}
        self._typedefs: dict[str, AbstractType] = {}

    def read(self, tree: Tree[Token], path: list[str]) -> None:
        """Read a definition in modules."""
        notes, *parts = tree.children
        annotations = [_annotation(one) for one in notes.children]  # type: ignore[union-attr]
        if tree.data == "module_dcl":
            for part in parts[1:]:
                self.read(part, [*path, str(parts[0])])  # type: ignore[arg-type]
        elif tree.data == "const_dcl":
            value = _value(parts[2])
            constant = Constant(str(parts[1]), _constant_type(_type(parts[0]), value), value)
            constant.annotations = annotations
            self._constants.setdefault(path[-1] if path else "", []).append(constant)
        elif tree.data == "typedef_dcl":
            name, kind = _declared(_type(parts[0]), parts[1])
            self._typedefs[name] = kind
        else:
            structure = Structure(NamespacedType(path, str(parts[0])))
            structure.annotations = annotations
            structure.members = [one for part in parts[1:] for one in self._members(part)]
            self.structures.append(structure)

    def message(self, structure: Structure) -> Message:
        """Return the message of a structure, with its constants."""
        message = Message(structure)
        message.constants = self._constants.get(structure.namespaced_type.name + CONSTANT_MODULE_SUFFIX, [])
        return message

    def _members(self, tree: Any) -> list[Member]:
        notes, kind, *declarators = tree.children
        members = []
        for declarator in declarators:
            name, declared = _declared(_type(kind), declarator)
            member = Member(self._resolved(declared), name)
            member.annotations = [_annotation(one) for one in notes.children]
            members.append(member)
        return members

    def _resolved(self, kind: Any) -> Any:
        """Return a type with those defined by typedef replaced; raises ValueError for an unknown one."""
        if isinstance(kind, NamedType):
            if kind.name not in self._typedefs:
                raise ValueError(f"the type '{kind.name}' is not known")
            return self._resolved(self._typedefs[kind.name])
        if isinstance(kind, AbstractNestedType):
            kind.value_type = self._resolved(kind.value_type)
        return kind


def _declared(kind: Any, tree: Any) -> tuple[str, Any]:
    """Return the name and the type of a declarator."""
    name, *sizes = tree.children
    for size in reversed(sizes):
        kind = Array(kind, _value(size))
    return str(name), kind


def _type(tree: Any) -> AbstractType:
    if tree.data == "basic_type":
        name = " ".join(str(tree.children[0]).split())
        return BasicType(_ALIASES.get(name, name))
    if tree.data == "named_type":
        names = [str(one) for one in tree.children[0].children]
        return NamedType(names[0]) if len(names) == 1 else NamespacedType(names[:-1], names[-1])
    bound = tree.children[-1]
    size = None if bound is None else _value(bound)
    if tree.data == "sequence_type":
        element = _type(tree.children[0])
        assert isinstance(element, AbstractNestableType)
        return UnboundedSequence(element) if size is None else BoundedSequence(element, size)
    if tree.data == "string_type":
        return UnboundedString() if size is None else BoundedString(size)
    return UnboundedWString() if size is None else BoundedWString(size)


def _constant_type(kind: AbstractType, value: Any) -> AbstractType:
    """Return the type of a constant: strings are as long as their value."""
    if isinstance(kind, UnboundedString):
        return BoundedString(len(value))
    return BoundedWString(len(value)) if isinstance(kind, UnboundedWString) else kind


def _annotation(tree: Any) -> Annotation:
    name = "::".join(str(one) for one in tree.children[0].children)
    arguments = [one for one in tree.children[1:] if one is not None]
    if not arguments:
        return Annotation(name, None)
    if arguments[0].data != "annotation_param":
        return Annotation(name, _value(arguments[0]))
    return Annotation(name, {str(one.children[0]): _value(one.children[1]) for one in arguments})


def _value(tree: Any) -> Any:
    """Return the value of a constant expression; of a name, the name."""
    if tree.data == "scoped_name":
        return "::".join(str(one) for one in tree.children)
    if tree.data == "string_literals":
        return get_string_literals_value(tree)
    if tree.data == "wide_string_literals":
        return get_string_literals_value(tree, allow_unicode=True)
    text = str(tree.children[0])
    if tree.data == "boolean":
        return text == "TRUE"
    if tree.data == "character":
        return text.removeprefix("L")[1:-1]
    if text.lower().lstrip("+-").startswith("0x"):
        return int(text, 16)
    try:
        return int(text)
    except ValueError:
        return float(text.rstrip("dDfF"))


def get_string_literals_value(tree: Tree[Token], *, allow_unicode: bool = False) -> str:
    """Return the text of adjacent string literals.

    Parameters
    ----------
    tree
        The literals.
    allow_unicode
        Whether they may be wide; their escapes stay as they are in any case but for quotes and backslashes.
    """
    texts = (str(one).removeprefix("L" if allow_unicode else "")[1:-1] for one in tree.children)
    return "".join(text.replace('\\"', '"').replace("\\\\", "\\") for text in texts)
