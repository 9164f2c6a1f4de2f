"""Scenarios as YAML files: reading and checking them, with the line of whatever is wrong."""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from daidalos.common.documents import DocumentError, parse_yaml, read_text
from daidalos.common.errors import Location, UserError
from daidalos.common.suggestions import hint

_SUBSTITUTION = re.compile(r"\$\(var ([^)]*)\)")
_CONDITION: dict[str, type] = {
    "equals": object, "tolerance": float, "yaw_tolerance": float, "above": float, "below": float, "between": list,
    "x": float, "y": float, "z": float, "roll": float, "pitch": float, "yaw": float,
}  # fmt: skip
_SOURCE: dict[str, type] = {
    "topic": str,
    "field": str,
    "transform": list,
    "robot": str,
    "of": str,
    "ignore": list,
    "point": list,
}
_ASSERTION = _SOURCE | _CONDITION

KINDS: dict[type, str] = {
    str: "a text", float: "a number", int: "a whole number", list: "a list", dict: "a mapping", bool: "true or false",
}  # fmt: skip

STEPS: dict[str, dict[str, type]] = {
    "wait": {},
    "drive": {"robot": str, "linear": float, "angular": float, "seconds": float},
    "publish": {"topic": str, "type": str, "message": dict},
    "call": {"service": str, "request": dict, "response": dict, "tolerance": float, "within": float},
    "send": {"action": str, "type": str, "goal": dict, "result": dict, "tolerance": float, "within": float},
    "eventually": _ASSERTION | {"within": float},
    "always": _ASSERTION | {"during": float},
    "never": _ASSERTION | {"during": float},
    "disturb": {"topic": str, "latency": float, "jitter": float, "loss": float},
    "drop_out": {"topic": str, "seconds": float},
    "restore": {"topic": str},
    "spawn": {"model": str, "name": str, "x": float, "y": float, "z": float, "yaw": float, "namespace": str},
    "box": {"name": str, "x": float, "y": float, "yaw": float, "size": list},
    "walk": {"name": str, "path": list, "speed": float, "loop": bool},
    "crowd": {"count": int, "speed": list, "avoid": list, "name": str},
    "move": {"model": str, "x": float, "y": float, "z": float, "yaw": float},
    "push": {"model": str, "link": str, "force": list, "seconds": float},
    "friction": {"model": str, "value": float, "link": str},
    "remove": {"model": str},
    "run": {
        "package": str, "executable": str, "arguments": list, "name": str, "namespace": str, "parameters": dict,
        "remap": dict, "use_sim_time": bool,
    },
    "launch": {"package": str, "file": str, "arguments": dict},
    "kill": {"node": str},
    "restart": {"node": str},
}  # fmt: skip
"""Steps of a scenario, with their keys and the kinds of their values."""

REQUIRED: dict[str, tuple[str, ...]] = {
    "drive": ("robot",),
    "publish": ("topic", "type"),
    "call": ("service",),
    "send": ("action", "type", "within"),
    "eventually": ("within",),
    "always": ("during",),
    "never": ("during",),
    "disturb": ("topic",),
    "drop_out": ("topic",),
    "restore": ("topic",),
    "spawn": ("model",),
    "box": ("name", "x", "y"),
    "walk": ("name", "path"),
    "crowd": ("count",),
    "move": ("model", "x", "y"),
    "push": ("model", "force"),
    "friction": ("model", "value"),
    "remove": ("model",),
    "run": ("package", "executable"),
    "launch": ("file",),
    "kill": ("node",),
    "restart": ("node",),
}

_WORD_STEPS = {"restore": "topic", "kill": "node", "restart": "node", "remove": "model", "drop_out": "topic"}
"""Steps that may be written with a single word, and the key that it stands for."""

_SCENARIO: dict[str, type] = {
    "name": str, "timeout": float, "seed": int, "parameters": dict, "world": str, "pictures": bool, "steps": list,
    "robots": list, "nodes": list, "launch": list, "always": list, "never": list,
}  # fmt: skip
_LISTS = {
    "robots": ("spawn", ("model",)),
    "nodes": ("run", ("package", "executable")),
    "launch": ("launch", ("file",)),
    "always": ("always", ()),
    "never": ("never", ()),
}


class Lines(dict[str, Any]):
    """Mapping of a YAML file that knows the lines of its keys."""

    lines: Mapping[str, int]
    line: int


@dataclass(frozen=True)
class Step:
    """Step of a scenario.

    Parameters
    ----------
    kind : str
        One of `STEPS`.
    values : mapping
        What it is given, by key.
    line : int
        In the file.
    """

    kind: str
    values: Mapping[str, Any]
    line: int


@dataclass(frozen=True)
class Document:
    """Scenario of a YAML file.

    Parameters
    ----------
    path : Path
    name : str
    timeout : float
        Simulated [s].
    seed : int
    world : str or None
        File or name of the world; None where there is none.
    pictures : bool
        Whether images and point clouds are recorded.
    parameters : mapping
        Values of ``$(var name)``.
    setting : tuple of Step
        What is there at the start: launched files, nodes, robots.
    requirements : tuple of Step
        What has to hold all the time.
    steps : tuple of Step
    """

    path: Path
    name: str
    timeout: float = 60.0
    seed: int = 0
    world: str | None = None
    pictures: bool = False
    parameters: Mapping[str, Any] = field(default_factory=dict)
    setting: tuple[Step, ...] = ()
    requirements: tuple[Step, ...] = ()
    steps: tuple[Step, ...] = ()


def read_scenario(path: Path, varied: Mapping[str, Any] | None = None) -> Document:
    """Read a scenario.

    Parameters
    ----------
    path : Path
    varied : mapping, optional
        Values of its parameters in place of those of the file.

    Raises
    ------
    UserError
        With the line, and the nearest known key.
    """
    try:
        content = parse_yaml(read_text(path), str(path), _loader, aliases=True)
    except OSError as error:
        raise UserError(f"{path}: {error.strerror or error}") from None
    return _Reader(path, varied or {}).document(content)


class _Reader:
    """Reader of one file."""

    def __init__(self, path: Path, varied: Mapping[str, Any]) -> None:
        self._path = path
        self._varied = varied
        self._parameters: dict[str, Any] = {}

    def document(self, content: Any) -> Document:
        if not isinstance(content, Lines):
            raise self._error("expected a mapping with the keys of a scenario, such as 'world' and 'steps'", 1)
        parameters = content.get("parameters") or {}
        if not isinstance(parameters, Mapping):
            raise self._error("expected a mapping of names to values below 'parameters'", content.lines["parameters"])
        self._parameters = dict(parameters)
        for name, value in self._varied.items():
            if name not in self._parameters:
                raise self._error(f"the scenario has no parameter '{name}'{hint(name, self._parameters)}", 1)
            self._parameters[name] = value
        values = self._checked(content, _SCENARIO, "a scenario")
        if not values.get("steps") and not any(values.get(name) for name in ("always", "never")):
            raise self._error("expected 'steps', or requirements below 'always' or 'never'", content.line)
        lists = {name: self._list(content, values, name) for name in _LISTS}
        return Document(
            self._path,
            values.get("name") or self._path.name.partition(".")[0],
            float(values.get("timeout", 60.0)),
            values.get("seed", 0),
            values.get("world"),
            values.get("pictures", False),
            self._parameters,
            (*lists["launch"], *lists["nodes"], *lists["robots"]),
            (*lists["always"], *lists["never"]),
            tuple(self._step(entry, content.lines["steps"]) for entry in values.get("steps") or ()),
        )

    def _list(self, content: Lines, values: Mapping[str, Any], name: str) -> list[Step]:
        kind, required = _LISTS[name]
        found = []
        for entry in values.get(name) or ():
            if not isinstance(entry, Lines):
                raise self._error(f"expected mappings below '{name}'", content.lines[name])
            given = self._checked(entry, STEPS[kind], f"an entry of '{name}'", required)
            found.append(Step(kind, given, entry.line))
        return found

    def _step(self, entry: Any, line: int) -> Step:
        if not isinstance(entry, Lines) or len(entry) != 1:
            line = getattr(entry, "line", line)
            raise self._error("expected a step: one key, such as 'drive' or 'eventually'", line)
        kind, given = next(iter(entry.items()))
        line = entry.lines[kind]
        if kind not in STEPS:
            raise self._error(f"there is no step '{kind}'{hint(kind, STEPS)}", line)
        given = self._substituted(given, line)
        if kind == "wait":
            return Step(kind, {"seconds": self._of_kind(given, float, "wait", line)}, line)
        if kind in _WORD_STEPS and isinstance(given, str):
            return Step(kind, {_WORD_STEPS[kind]: given}, line)
        if not isinstance(given, Lines):
            raise self._error(f"expected a mapping below '{kind}'", line)
        return Step(kind, self._checked(given, STEPS[kind], f"the step '{kind}'", REQUIRED.get(kind, ())), line)

    def _checked(
        self, given: Lines, known: Mapping[str, type], what: str, required: Sequence[str] = ()
    ) -> dict[str, Any]:
        """Return the values of a mapping whose keys are known, with their parameters filled in."""
        values = {}
        for key, value in given.items():
            line = given.lines[key]
            if key not in known:
                raise self._error(f"{what} has no '{key}'{hint(key, known)}", line)
            values[key] = self._of_kind(self._substituted(value, line), known[key], key, line)
        for key in required:
            if key not in given:
                raise self._error(f"{what} needs '{key}'", given.line)
        return values

    def _of_kind(self, value: Any, kind: type, key: str, line: int) -> Any:
        is_number = isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= sys.float_info.max
        fits = {float: is_number, int: is_number and int(value) == value if is_number else False}.get(
            kind, isinstance(value, kind)
        )
        if not fits:
            raise self._error(f"'{key}' should be {KINDS.get(kind, 'a value')}, got {value!r}", line)
        return float(value) if kind is float else value

    def _substituted(self, value: Any, line: int) -> Any:
        """Return a value with the parameters that it refers to; a text that is nothing else gets their type."""
        if isinstance(value, Lines):
            filled = Lines({key: self._substituted(one, value.lines[key]) for key, one in value.items()})
            filled.lines, filled.line = value.lines, value.line
            return filled
        if isinstance(value, list):
            return [self._substituted(one, line) for one in value]
        if not isinstance(value, str):
            return value
        whole = _SUBSTITUTION.fullmatch(value)
        if whole is not None:
            return self._parameter(whole[1], line)
        return _SUBSTITUTION.sub(lambda match: str(self._parameter(match[1], line)), value)

    def _parameter(self, name: str, line: int) -> Any:
        if name not in self._parameters:
            raise self._error(f"there is no parameter '{name}'{hint(name, self._parameters)}", line)
        return self._parameters[name]

    def _error(self, problem: str, line: int) -> UserError:
        return UserError(problem, Location(str(self._path), line))


def _loader(text: str) -> Any:
    """Return a loader of YAML whose mappings know their lines."""
    import yaml

    class Loader(yaml.SafeLoader):
        """PyYAML's safe loader."""

    def mapping(loader: Any, node: Any) -> Lines:
        found = Lines()
        found.line = node.start_mark.line + 1
        lines: dict[str, int] = {}
        loader.flatten_mapping(node)
        for key_node, value_node in node.value:
            key = loader.construct_object(key_node, deep=True)
            line = key_node.start_mark.line + 1
            if not isinstance(key, str):
                raise DocumentError(f"expected a name as key, got {key!r}", None, line)
            if key in found:
                raise yaml.MarkedYAMLError(problem=f"'{key}' is given twice", problem_mark=key_node.start_mark)
            found[key] = loader.construct_object(value_node, deep=True)
            lines[key] = line
        found.lines = lines
        return found

    Loader.add_constructor("tag:yaml.org,2002:map", mapping)
    return Loader(text)
