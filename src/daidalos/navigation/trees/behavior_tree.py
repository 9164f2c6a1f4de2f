"""Behavior trees in the format of BehaviorTree.CPP and Nav2: reading, ticking, halting and drawing."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import py_trees
from py_trees.common import Status

from daidalos.common.errors import Location
from daidalos.common.extensions import ExtensionError, find
from daidalos.common.suggestions import hint
from daidalos.description.errors import DescriptionError
from daidalos.description.markup import Element, parse_markup
from daidalos.navigation.extensions import TREE_NODES
from daidalos.navigation.trees.blackboard import Blackboard
from daidalos.navigation.trees.conditions import CONDITIONS, Conditioned
from daidalos.navigation.trees.errors import TreeError
from daidalos.navigation.trees.node import Ports, TreeContext
from daidalos.navigation.trees.services import Services

DEFAULT_TREE = (
    Path(__file__).parents[2] / "share/nav2_bt_navigator/behavior_trees/navigate_to_pose_w_replanning_and_recovery.xml"
)
"""Default tree of `navigate_to_pose`."""

THROUGH_POSES_TREE = DEFAULT_TREE.with_name("navigate_through_poses_w_replanning_and_recovery.xml")
"""Default tree of `navigate_through_poses`."""

_EXPLICIT = frozenset({"Action", "Condition", "Control", "Decorator"})
_COMMENTARY = frozenset({"name", "ID", "_description", "_fullpath", "_uid", *CONDITIONS})


class BehaviorTree:
    """Behavior tree that can be ticked.

    Parameters
    ----------
    root : py_trees behaviour
        Its root.
    blackboard : Blackboard
        What its nodes share.
    """

    def __init__(self, root: Any, blackboard: Blackboard) -> None:
        self.root = root
        self.blackboard = blackboard

    @classmethod
    def load(cls, path: Path, services: Services, blackboard: Blackboard | None = None) -> BehaviorTree:
        """Read the tree of a file.

        Raises
        ------
        TreeError
            The file cannot be read, is not XML, or names a node or port that does not exist.
        """
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise TreeError(f"cannot be read: {error}", Location(str(path))) from None
        return cls.parse(text, services, blackboard, str(path))

    @classmethod
    def parse(
        cls, text: str, services: Services, blackboard: Blackboard | None = None, source: str = "tree"
    ) -> BehaviorTree:
        """Read a tree.

        Parameters
        ----------
        text : str
            XML of BehaviorTree.CPP, version 3 or 4.
        services : Services
            What the leaves ask of the robot.
        blackboard : Blackboard, optional
            Values that the tree begins with.
        source : str
            Where the text came from; errors name it.

        Raises
        ------
        TreeError
            It is not XML, or names a node or port that does not exist.
        """
        board = blackboard or Blackboard()
        trees, main = _trees(_document(text, source), Path(source).parent)
        builder = _Builder(trees, services)
        return cls(builder.subtree(main, board, trees[main], ()), board)

    @property
    def status(self) -> Status:
        """Status of the last tick."""
        return self.root.status

    def tick(self) -> Status:
        """Tick the tree once; `RUNNING` until it has succeeded or failed. A tree that is skipped fails."""
        self.root.tick_once()
        return Status.FAILURE if self.root.status == Status.INVALID else self.root.status

    def halt(self) -> None:
        """Halt all running nodes."""
        self.root.stop(Status.INVALID)

    def to_text(self) -> str:
        """Draw the tree with the state of each node."""
        drawing: str = py_trees.display.unicode_tree(self.root, show_status=True)
        return drawing


def _document(text: str, source: str) -> Element:
    try:
        root = parse_markup(text, source)
    except DescriptionError as error:
        raise TreeError(str(error)) from None
    if root.tag != "root":
        raise TreeError(f"the outermost element must be <root>, not <{root.tag}>", root.location)
    return root


def _trees(root: Element, folder: Path, seen: frozenset[Path] = frozenset()) -> tuple[dict[str, Element], str]:
    """Return the trees of a file and its includes by ID, and the ID of the main tree."""
    trees: dict[str, Element] = {}
    for include in root.all("include"):
        path = (folder / include.attributes.get("path", "")).resolve()
        if not path.is_file() or path in seen:
            why = "includes itself" if path in seen else "does not exist"
            raise TreeError(f"the included file {path} {why}", include.location)
        inner = _document(path.read_text(encoding="utf-8"), str(path))
        trees.update(_trees(inner, path.parent, seen | {path})[0])
    own = [tree.attributes.get("ID", "MainTree") for tree in root.all("BehaviorTree")]
    trees.update(zip(own, root.all("BehaviorTree"), strict=True))
    if not trees:
        raise TreeError("there is no <BehaviorTree>", root.location)
    main = root.attributes.get("main_tree_to_execute") or (own[0] if len(own) == 1 else "MainTree")
    if main not in trees and not seen:
        raise TreeError(f"there is no tree {main!r}; the trees are: {', '.join(trees)}", root.location)
    return trees, main


class _Builder:
    """Builder of nodes from elements."""

    def __init__(self, trees: dict[str, Element], services: Services) -> None:
        self._trees = trees
        self._services = services

    def subtree(self, identifier: str, board: Blackboard, element: Element, path: tuple[str, ...]) -> Any:
        """Return the root node of a tree; `element` refers to it."""
        if identifier not in self._trees:
            raise TreeError(
                f"{element.label}: there is no tree {identifier!r}{hint(identifier, self._trees)}", element.location
            )
        if identifier in path:
            raise TreeError(f"{element.label}: the tree {identifier!r} contains itself", element.location)
        tree = self._trees[identifier]
        if len(tree.children) != 1:
            raise TreeError(f"the tree {identifier!r} must have one root, not {len(tree.children)}", tree.location)
        return self._node(tree.children[0], board, (*path, identifier))

    def _node(self, element: Element, board: Blackboard, path: tuple[str, ...]) -> Any:
        node = self._bare_node(element, board, path)
        conditions = {name: text for name, text in element.attributes.items() if name in CONDITIONS}
        return Conditioned(node, conditions, board, _place(element)) if conditions else node

    def _bare_node(self, element: Element, board: Blackboard, path: tuple[str, ...]) -> Any:
        """Return a node without its conditions."""
        identifier = element.attributes.get("ID", "") if element.tag in _EXPLICIT else element.tag
        if identifier in ("SubTree", "SubTreePlus"):
            return self._inner_tree(element, board, path)
        location = Location(element.source or None, element.line or None, element.label)
        try:
            made_by = find(TREE_NODES, identifier, asked_by=location)
        except ExtensionError as error:
            raise TreeError(str(error)) from None
        children = [self._node(child, board, path) for child in element.children]
        _check_number(element, len(children), made_by.CHILDREN)
        attributes = {k: v for k, v in element.attributes.items() if k not in _COMMENTARY}
        ports = Ports(made_by.PORTS, attributes, board, _place(element))
        return made_by(ports, TreeContext(element.attributes.get("name", identifier), self._services, children))

    def _inner_tree(self, element: Element, board: Blackboard, path: tuple[str, ...]) -> Any:
        """Return a subtree with a blackboard of its own, whose remapped names refer to this one's."""
        attributes = element.attributes
        auto = {attributes.get(key) for key in ("_autoremap", "__autoremap", "__shared_blackboard")}
        inner = Blackboard(
            board,
            {k: v[1:-1] for k, v in attributes.items() if v.startswith("{") and v.endswith("}")},
            autoremap=bool(auto & {"true", "1"}),
        )
        for key, text in attributes.items():
            if not key.startswith("_") and key not in _COMMENTARY and not text.startswith("{"):
                inner.set(key, text)
        return self.subtree(attributes.get("ID", ""), inner, element, path)


def _check_number(element: Element, number: int, allowed: tuple[int, int | None]) -> None:
    fewest, most = allowed
    if number >= fewest and (most is None or number <= most):
        return
    wanted = f"at least {fewest}" if most is None else f"{fewest}" if most == fewest else f"{fewest} to {most}"
    raise TreeError(f"{element.label}: it must have {wanted} children, not {number}", element.location)


def _place(element: Element) -> str:
    return f"{element.where}: {element.label}"
