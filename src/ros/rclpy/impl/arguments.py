"""Command-line arguments: what stands between ``--ros-args`` and ``--`` (REP-less; ROS 2's "node arguments")."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from daidalos.common.errors import Location
from rclpy.impl import names
from rclpy.impl.errors import RCLInvalidROSArgsError, UnknownROSArgsError
from rclpy.impl.names import RemapRule

ROS_ARGS = "--ros-args"
END = "--"
SEVERITIES = {"debug": 10, "info": 20, "warn": 30, "error": 40, "fatal": 50}
_NODE_PREFIX = re.compile(r"(?P<node>[A-Za-z_]\w*):(?!//)(?P<rest>[^=].*)")
_SCHEME = re.compile(r"(?P<scheme>rostopic|rosservice)://(?P<rest>.*)")


class GivenParameter(NamedTuple):
    """A parameter's value from a file or from ``-p``, for the nodes whose names match `node`."""

    node: str
    name: str
    value: Any
    location: Location


@dataclass
class RosArguments:
    """Parsed ROS arguments.

    Attributes
    ----------
    remaps
        In the order given.
    parameters
        From ``-p``, which is for the node "/**" where it names none, and from files, in the order given.
    log_levels
        Severity by logger name; "" is the default.
    enclave
        Security enclave.
    rest
        The arguments that are not ROS's, the program's name included.
    """

    remaps: list[RemapRule] = field(default_factory=list)
    parameters: list[GivenParameter] = field(default_factory=list)
    log_levels: dict[str, int] = field(default_factory=dict)
    stdout_logs: bool = True
    rosout_logs: bool = True
    external_lib_logs: bool = True
    log_file_name: str = ""
    enclave: str = "/"
    rest: list[str] = field(default_factory=list)


_SWITCHES = {
    "stdout-logs": "stdout_logs",
    "rosout-logs": "rosout_logs",
    "external-lib-logs": "external_lib_logs",
}


def split_ros_args(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Separate arguments into (those of ROS, all others)."""
    ros: list[str] = []
    rest: list[str] = []
    inside = False
    for argument in arguments:
        if argument == ROS_ARGS:
            inside = True
        elif inside and argument == END:
            inside = False
        else:
            (ros if inside else rest).append(argument)
    return ros, rest


def parse(arguments: Sequence[str]) -> RosArguments:
    """Read the arguments of a process or of one node.

    Raises
    ------
    UnknownROSArgsError
        For an unknown flag.
    RCLInvalidROSArgsError
        For a flag whose value is missing or cannot be read.
    """
    ros, rest = split_ros_args(arguments)
    result = RosArguments(rest=rest)
    pending = list(reversed(ros))
    while pending:
        flag = pending.pop()
        _parse_flag(result, flag, pending)
    return result


def _parse_flag(result: RosArguments, flag: str, pending: list[str]) -> None:
    switch = re.fullmatch(r"--(enable|disable)-(.+)", flag)
    if switch and switch[2] in _SWITCHES:
        setattr(result, _SWITCHES[switch[2]], switch[1] == "enable")
    elif flag in ("-r", "--remap"):
        result.remaps.append(parse_remap(_value(flag, pending)))
    elif flag in ("-p", "--param"):
        result.parameters.append(_parse_parameter(_value(flag, pending)))
    elif flag == "--params-file":
        result.parameters += _read_file(_value(flag, pending))
    elif flag == "--log-level":
        name, level = _parse_log_level(_value(flag, pending))
        result.log_levels[name] = level
    elif flag in ("-e", "--enclave"):
        result.enclave = _value(flag, pending)
    elif flag in ("--log-config-file", "--log-file-name"):
        value = _value(flag, pending)
        if flag == "--log-file-name":
            result.log_file_name = value
    elif ":=" in flag and not flag.startswith("-"):
        result.remaps.append(parse_remap(flag))
    else:
        raise UnknownROSArgsError(f"Found unknown ROS arguments: {[flag]}")


def _bad(what: str) -> RCLInvalidROSArgsError:
    return RCLInvalidROSArgsError(f"Failed to parse ROS arguments: {what}")


def _value(flag: str, pending: list[str]) -> str:
    if not pending:
        raise _bad(f"'{flag}' needs a value")
    return pending.pop()


def parse_remap(text: str) -> RemapRule:
    """Read ``from:=to``, ``node:from:=to``, ``__ns:=/x``, ``__node:=x`` or ``rostopic://from:=to``.

    Raises
    ------
    RCLInvalidROSArgsError
        When it is not one of these.
    """
    match, separator, replacement = text.partition(":=")
    if not separator or not match or not replacement:
        raise _bad(f"couldn't parse remap rule: '{text}'; expected 'from:=to'")
    node = ""
    prefixed = _NODE_PREFIX.fullmatch(match)
    if prefixed:
        node, match = prefixed["node"], prefixed["rest"]
    if match in ("__node", "__name"):
        return _checked_node(RemapRule("node", "", replacement, node), text)
    if match == "__ns":
        return _checked_namespace(RemapRule("ns", "", replacement, node), text)
    scheme = _SCHEME.fullmatch(match)
    kind = "any"
    if scheme:
        kind, match = scheme["scheme"].removeprefix("ros"), scheme["rest"]
    return RemapRule(kind, match, replacement, node)


def _checked_node(rule: RemapRule, text: str) -> RemapRule:
    fault = names.node_name_error(rule.replacement)
    if fault:
        raise _bad(f"couldn't parse remap rule: '{text}': {fault[0]}")
    return rule


def _checked_namespace(rule: RemapRule, text: str) -> RemapRule:
    fault = names.namespace_error(rule.replacement)
    if fault:
        raise _bad(f"couldn't parse remap rule: '{text}': {fault[0]}")
    return rule


def _parse_parameter(text: str) -> GivenParameter:
    from rclpy.impl.parameter_file import parse_value

    name, separator, value = text.partition(":=")
    if not separator or not name:
        raise _bad(f"couldn't parse parameter override rule: '-p {text}'; expected 'name:=value'")
    node = "/**"
    prefixed = _NODE_PREFIX.fullmatch(name)
    if prefixed:
        node, name = prefixed["node"], prefixed["rest"]
    try:
        return GivenParameter(node, name, parse_value(value), Location(f"-p {text}"))
    except ValueError as error:
        raise _bad(f"couldn't parse parameter override rule: '-p {text}': {error}") from None


def _read_file(path: str) -> list[GivenParameter]:
    from rclpy.impl.parameter_file import ParameterFileError, read_file

    try:
        return [GivenParameter(*entry) for entry in read_file(path)]
    except ParameterFileError as error:
        raise _bad(f"couldn't parse params file: '--params-file {path}': {error}") from None


def _parse_log_level(text: str) -> tuple[str, int]:
    name, separator, level = text.rpartition(":=")
    severity = SEVERITIES.get(level.lower())
    if severity is None or (separator and not name):
        raise _bad(f"couldn't parse log level rule: '--log-level {text}'; expected one of {', '.join(SEVERITIES)}")
    return name, severity
