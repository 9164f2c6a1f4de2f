"""Contract of tree nodes: ports, children and construction."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import py_trees
from py_trees.common import Status

from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.navigation.trees.errors import TreeError
from daidalos.navigation.trees.services import Services

REQUIRED: Any = object()
"""Default of an input port that must be given."""


@dataclass(frozen=True)
class Port:
    """Attribute of a node: a value, or a name of the blackboard in braces.

    Attributes
    ----------
    kind : callable
        Turns the text of the file into a value: `float`, `int`, `str`, `flag`, or `entry` for values that
        only the blackboard can hold.
    default : object
        Value of an input that the file does not give.
    output : bool
        Whether the node writes it.
    field : str
        Field of an action's goal, request or result that has the value, such as ``target.x``, where its name differs.
    """

    kind: Callable[[str], Any]
    default: Any = REQUIRED
    output: bool = False
    field: str = ""


def flag(text: str) -> bool:
    """Parse a Boolean in BehaviorTree.CPP's notation."""
    words = {"true": True, "1": True, "false": False, "0": False}
    return words[text.strip().lower()]


def entry(text: str) -> Any:
    """Raise an error for a literal where only an entry of the blackboard is valid."""
    raise ValueError


class Ports:
    """Ports of one node, bound to a blackboard.

    Parameters
    ----------
    declared : mapping of str to Port
        What the node has.
    attributes : mapping of str to str
        What the file gives.
    blackboard : Blackboard
        Where names in braces live.
    where : str
        File, line and element, for errors.
    """

    def __init__(
        self,
        declared: Mapping[str, Port],
        attributes: Mapping[str, str],
        blackboard: Blackboard,
        where: str = "",
    ) -> None:
        self._declared = declared
        self._blackboard = blackboard
        self._where = where
        self._names: dict[str, str] = {}
        self._values: dict[str, Any] = {}
        for key, text in attributes.items():
            self._bind(key, text)
        for key, port in declared.items():
            if port.default is REQUIRED and not port.output and key not in attributes:
                raise TreeError(f"{where}: the port {key!r} is missing")

    @property
    def where(self) -> str:
        """File, line and element."""
        return self._where

    @property
    def blackboard(self) -> Blackboard:
        """Blackboard of the node's tree."""
        return self._blackboard

    def get(self, key: str) -> Any:
        """Return the value of an input: from the blackboard, from the file, or the default."""
        if key in self._names:
            port = self._declared[key]
            value = self._blackboard.get(self._names[key], None if port.default is REQUIRED else port.default)
            return self._read(key, value) if isinstance(value, str) and port.kind is not entry else value
        return self._values.get(key, self._declared[key].default)

    def is_bound(self, key: str) -> bool:
        """Return whether the file binds a port to a name of the blackboard."""
        return key in self._names

    def name_of(self, key: str) -> str:
        """Return the name of the blackboard that an input gives, in braces or without."""
        return self._names.get(key) or str(self.get(key))

    def inputs(self) -> dict[str, Any]:
        """Return all inputs that have a value."""
        values = {key: self.get(key) for key, port in self._declared.items() if not port.output}
        return {key: value for key, value in values.items() if value is not None}

    def set(self, key: str, value: Any) -> None:
        """Write an output to the blackboard if the file binds it to a name."""
        if key in self._names:
            self._blackboard.set(self._names[key], value)

    def _bind(self, key: str, text: str) -> None:
        port = self._declared.get(key)
        if port is None:
            known = ", ".join(self._declared) or "none"
            raise TreeError(f"{self._where}: there is no port {key!r}; the ports are: {known}")
        if text.startswith("{") and text.endswith("}"):
            name = text[1:-1].removeprefix("@").strip()
            self._names[key] = key if name == "=" else name
            return
        if port.output:
            raise TreeError(f"{self._where}: the output {key!r} must be a name in braces, not {text!r}")
        self._values[key] = self._read(key, text)

    def _read(self, key: str, text: str) -> Any:
        """Parse text as a value of the port's type."""
        port = self._declared[key]
        try:
            return port.kind(text)
        except (ValueError, KeyError):
            wanted = "a name in braces" if port.kind is entry else f"a {port.kind.__name__}"
            raise TreeError(f"{self._where}: the port {key!r} must be {wanted}, not {text!r}") from None


@dataclass(frozen=True)
class TreeContext:
    """Context of a tree node beside its ports.

    Attributes
    ----------
    name : str
        For people.
    services : Services
        What it asks of the robot.
    children : sequence of py_trees behaviours
        The nodes below it.
    """

    name: str
    services: Services
    children: Sequence[py_trees.behaviour.Behaviour] = ()


class TreeNode:
    """The contract of tree nodes, made with ``(ports, context)``: a `Node`, a `Control` or a `Decorator`.

    Attributes
    ----------
    names : tuple of str
        Class attribute: names of a built-in class in files.
    PORTS : mapping of str to Port
        Class attribute: its attributes in a file.
    CHILDREN : tuple of int and int or None
        Class attribute: fewest and most children.
    ports : Ports
    services : Services
    """

    names: ClassVar[tuple[str, ...]] = ()
    PORTS: ClassVar[Mapping[str, Port]] = {}
    CHILDREN: ClassVar[tuple[int, int | None]] = (0, 0)
    ports: Ports
    services: Services

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        raise NotImplementedError


class Node(TreeNode, py_trees.behaviour.Behaviour):  # type: ignore[misc]
    """A leaf: `update` returns how it ended, or `RUNNING`."""

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        py_trees.behaviour.Behaviour.__init__(self, context.name)
        self.ports = ports
        self.services = context.services


class Control(TreeNode, py_trees.composites.Composite):  # type: ignore[misc]
    """A node with children that it ticks as it likes; see `TreeNode` for the attributes."""

    CHILDREN: ClassVar[tuple[int, int | None]] = (1, None)

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        py_trees.composites.Composite.__init__(self, context.name, children=list(context.children))
        self.ports = ports
        self.services = context.services

    def conclude(self, status: Status, runs: Any = None) -> None:
        """Finish a tick.

        Parameters
        ----------
        status : Status
            How it ended. With anything but `RUNNING` all children are reset.
        runs : behaviour, optional
            The only child that may go on running, if the node runs; all may if it is not given.
        """
        if status != Status.RUNNING:
            for child in self.children:
                if child.status != Status.INVALID:
                    child.stop(Status.INVALID)
            self.stop(status)
            return
        self.status = status
        for child in self.children:
            if runs is not None and child is not runs and child.status == Status.RUNNING:
                child.stop(Status.INVALID)


class Decorator(TreeNode, py_trees.decorators.Decorator):  # type: ignore[misc]
    """A node with one child; see `TreeNode` for the attributes."""

    CHILDREN: ClassVar[tuple[int, int | None]] = (1, 1)
    status: Status

    def __init__(self, ports: Ports, context: TreeContext) -> None:
        py_trees.decorators.Decorator.__init__(self, context.name, context.children[0])
        self.ports = ports
        self.services = context.services

    def update(self) -> Status:
        """Return the status of the child."""
        return self.decorated.status
