"""Parameter values and files in YAML, with the types that ROS 2 gives them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import yaml

from daidalos.common.documents import DocumentError, parse_yaml, read_text
from daidalos.common.errors import Location

_INTEGER_MAX = 2**63 - 1
ORIGIN = "# from: "
"""What the first line of a file that a launch file wrote begins with; the launch file's path follows."""


class ParameterFileError(ValueError):
    """A parameter file cannot be used; the message says where and why."""


class _Loader(yaml.SafeLoader):
    """YAML as rcl_yaml_param_parser reads it: 1e3 is a float, `on` and `yes` are booleans, dates are text.

    A name that stands there twice adds to what it held. Aliases are refused, as ROS 2 does.
    """

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        """Return the names, which know their lines, and values of a mapping."""
        values: dict[Any, list[Any]] = {}
        lines: dict[Any, int] = {}
        for key, value in node.value:
            name = self.construct_object(key, deep=True)
            if isinstance(name, (list, dict, set)):
                raise yaml.MarkedYAMLError(problem="a name must be plain text", problem_mark=key.start_mark)
            values.setdefault(name, []).append(self.construct_object(value, deep=True))
            lines[name] = key.start_mark.line + 1
        return {_Name(name, lines[name]): _merged(found) for name, found in values.items()}


class _Name(str):
    """A name in a file.

    Attributes
    ----------
    line : int
        Where it is, from 1.
    """

    __slots__ = ("line",)
    line: int

    def __new__(cls, name: Any, line: int) -> _Name:
        made = super().__new__(cls, name)
        made.line = line
        return made


def _merged(values: list[Any]) -> Any:
    merged: Any = values[0]
    for value in values[1:]:
        if isinstance(merged, dict) and isinstance(value, dict):
            merged = merged | {
                name: _merged([merged[name], inner]) if name in merged else inner for name, inner in value.items()
            }
        else:
            merged = value
    return merged


_Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != "tag:yaml.org,2002:timestamp"]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(
        r"""^(?:[-+]?(?:[0-9][0-9_]*)\.[0-9_]*(?:[eE][-+]?[0-9]+)?
        |[-+]?(?:[0-9][0-9_]*)(?:[eE][-+]?[0-9]+)
        |\.[0-9_]+(?:[eE][-+]?[0-9]+)?
        |[-+]?\.(?:inf|Inf|INF)
        |\.(?:nan|NaN|NAN))$""",
        re.VERBOSE,
    ),
    list("-+0123456789."),
)


def parse_value(text: str) -> Any:
    """Read one value: bool, int, float, str or a list of one of these.

    Raises
    ------
    ValueError
        When it is no such value.
    """
    try:
        value = parse_yaml(text, loader=_Loader, aliases=False)
    except DocumentError as error:
        raise ValueError(error.described) from None
    if text.strip() and value is None and text.strip().lower() not in ("~", "null"):
        return text
    return check_value(text if isinstance(value, dict) else "" if value is None else value)


def check_value(value: Any) -> Any:
    """Return `value` if a parameter can hold it.

    Raises
    ------
    ValueError
        Saying why not.
    """
    if isinstance(value, list):
        kinds = {type(item) for item in value}
        if kinds == {int, float}:
            return [float(item) for item in value]
        if len(kinds) > 1:
            raise ValueError(f"a list must hold values of one type, not {value}")
        for item in value:
            if isinstance(item, (list, dict)) or item is None:
                raise ValueError(f"a list must hold plain values, not {item}")
            check_value(item)
        return value
    if isinstance(value, bool | str | float):
        return value
    if isinstance(value, int):
        if not -_INTEGER_MAX - 1 <= value <= _INTEGER_MAX:
            raise ValueError(f"{value} does not fit into 64 bits")
        return value
    raise ValueError(f"a parameter cannot hold {value!r}")


def read_file(path: str | Path) -> list[tuple[str, str, Any, Location]]:
    """Read a parameter file.

    Returns
    -------
    list of (str, str, value, Location)
        Node name (with its namespace; ``*`` and ``**`` are wildcards), parameter name, value and where the name is
        written; in order. A first line ``# from: FILE``, as launch writes it, names the launch file that gave the
        values.

    Raises
    ------
    ParameterFileError
        Naming the place in the file.
    """
    try:
        text = read_text(path)
        document = parse_yaml(text, str(path), _Loader, aliases=False)
    except OSError as error:
        raise ParameterFileError(f"{error.strerror or error}") from None
    except DocumentError as error:
        raise ParameterFileError(error.described) from None
    if document is None:
        return []
    if not isinstance(document, dict):
        raise ParameterFileError("expected node names at the top, each with 'ros__parameters' below")
    found: list[tuple[str, str, Any, int]] = []
    _walk_nodes(document, "", found)
    first = text.partition("\n")[0]
    written_in = first.removeprefix(ORIGIN) if first.startswith(ORIGIN) else ""
    return [
        (node, name, value, Location(written_in or str(path), None if written_in else line))
        for node, name, value, line in found
    ]


def _walk_nodes(tree: dict[str, Any], prefix: str, found: list[tuple[str, str, Any, int]]) -> None:
    for name, value in tree.items():
        if name == "ros__parameters":
            if not prefix:
                raise ParameterFileError("'ros__parameters' stands at the top; put it below a node's name or '/**'")
            if value is not None and not isinstance(value, dict):
                raise ParameterFileError(f"'ros__parameters' of '{prefix}' must hold names and values")
            _walk_parameters(value or {}, "", prefix, found)
        elif isinstance(value, dict):
            _walk_nodes(value, f"{prefix}/{str(name).strip('/')}" if prefix else str(name), found)
        elif value is not None:
            raise ParameterFileError(f"'{name}' has a value outside of 'ros__parameters'")


def _walk_parameters(tree: dict[_Name, Any], prefix: str, node: str, found: list[tuple[str, str, Any, int]]) -> None:
    for key, value in tree.items():
        name = f"{prefix}.{key}" if prefix else str(key)
        if isinstance(value, dict):
            _walk_parameters(value, name, node, found)
        elif isinstance(value, list) and value and all(isinstance(item, dict) for item in value):
            for item in value:  # rcl's parser reads the names of mappings in a list as if there were no list
                _walk_parameters(item, name, node, found)
        elif value is not None:
            try:
                found.append((node, name, check_value(value), key.line))
            except ValueError as error:
                raise ParameterFileError(f"line {key.line}: parameter '{name}' of '{node}': {error}") from None


def node_matches(pattern: str, full_name: str) -> bool:
    """Return whether a node name in a file means the node `full_name` (such as ``/lab/talker``)."""
    if not pattern.startswith("/"):
        pattern = f"/{pattern}"
    if pattern == full_name or pattern == "/**":
        return True
    if "*" not in pattern:
        return False
    text = re.escape(pattern).replace(r"/\*\*", r"(?:/[^/]+)*").replace(r"\*", r"[^/]+")
    return re.fullmatch(text, full_name) is not None
