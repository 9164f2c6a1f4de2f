"""Drawings of the tree of a robot or a model, as SVG or for Graphviz."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from xml.sax.saxutils import escape

from daidalos.description.joint import Joint
from daidalos.description.robot import Robot
from daidalos.description.tree import LinkTree, link_tree
from daidalos.description.world import Model

_LETTER = 7.2
_HEIGHT = 26.0
_GAP = 24.0
_LEVEL = 96.0
_MARGIN = 20.0


@dataclass(frozen=True)
class _Node:
    name: str
    x: float
    y: float
    width: float


def to_svg(robot: Robot | Model) -> str:
    """Draw links as boxes and joints as arrows between them, roots on top.

    Each parent stands over the middle of its children, and no two subtrees overlap. Joints that close loops
    are arrows as well.
    """
    tree = link_tree(robot)
    nodes, width = _place(tree)
    height = max((node.y for node in nodes.values()), default=0.0) + _HEIGHT / 2 + _MARGIN
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
        f'width="{width:.0f}" height="{height:.0f}" font-family="sans-serif" font-size="12">',
        f"<title>{escape(robot.name)}</title>",
        '<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="7" markerHeight="7" '
        'orient="auto"><path d="M0,0 8,4 0,8z" fill="#456"/></marker></defs>',
    ]
    joints = [(joint, nodes[joint.parent], nodes[joint.child]) for joint in robot.joints.values()]
    parts += [_arrow(parent, child, joint) for joint, parent, child in joints]
    # A label is above its child, but that of a joint that closes a loop is below its parent, where space is free.
    parts += [
        _label(parent if joint in tree.closing else child, parent, child, joint) for joint, parent, child in joints
    ]
    parts += [_box(node) for node in nodes.values()]
    return "\n".join([*parts, "</svg>"]) + "\n"


def to_dot(robot: Robot | Model) -> str:
    """Return the tree in Graphviz's language, in the style of ``urdf_to_graphviz``."""
    lines = ["digraph G {", "node [shape=box];"]
    lines += [f'"{link}" [label="{link}"];' for link in robot.links]
    lines.append("node [shape=ellipse, color=blue, fontcolor=blue];")
    for joint in robot.joints.values():
        lines.append(f'"{joint.parent}" -> "{joint.name}" [label="{_origin(joint)}"]')
        lines.append(f'"{joint.name}" -> "{joint.child}"')
    return "\n".join([*lines, "}"]) + "\n"


def _place(tree: LinkTree) -> tuple[dict[str, _Node], float]:
    """Compute the position of every link; return the positions and the width of the drawing."""
    order = [(root, 0) for root in tree.roots]
    for name, depth in order:
        order += [(joint.child, depth + 1) for joint in tree.children.get(name, ())]
    own = {name: max(_LETTER * len(name) + 16, 60.0) for name, _ in order}
    # Include the label of the joint above.
    label = {j.child: _LETTER * 0.9 * len(j.name) + 12 for joints in tree.children.values() for j in joints}
    span: dict[str, float] = {}
    for name, _ in reversed(order):
        below = [joint.child for joint in tree.children.get(name, ())]
        span[name] = max(own[name], label.get(name, 0.0), _subtree_width(below, span))
    left = _side_by_side(tree.roots, span, _MARGIN)
    nodes = {}
    for name, depth in order:
        nodes[name] = _Node(name, left[name] + span[name] / 2, _MARGIN + _HEIGHT / 2 + depth * _LEVEL, own[name])
        below = [joint.child for joint in tree.children.get(name, ())]
        left |= _side_by_side(below, span, left[name] + (span[name] - _subtree_width(below, span)) / 2)
    return nodes, _subtree_width(tree.roots, span) + 2 * _MARGIN


def _side_by_side(names: Sequence[str], span: dict[str, float], start: float) -> dict[str, float]:
    """Return the left edges of subtrees in a row."""
    left = {}
    for name in names:
        left[name] = start
        start += span[name] + _GAP
    return left


def _subtree_width(names: Sequence[str], span: dict[str, float]) -> float:
    """Return the total width of subtrees side by side."""
    return sum(span[name] for name in names) + _GAP * max(0, len(names) - 1)


def _box(node: _Node) -> str:
    return (
        f'<rect x="{node.x - node.width / 2:.1f}" y="{node.y - _HEIGHT / 2:.1f}" width="{node.width:.1f}" '
        f'height="{_HEIGHT}" rx="5" fill="#eef3f8" stroke="#456"/>'
        f'<text x="{node.x:.1f}" y="{node.y + 4:.1f}" text-anchor="middle">{escape(node.name)}</text>'
    )


def _arrow(parent: _Node, child: _Node, joint: Joint) -> str:
    start, end = parent.y + _HEIGHT / 2, child.y - _HEIGHT / 2
    middle = (start + end) / 2
    path = f"M{parent.x:.1f},{start:.1f} C{parent.x:.1f},{middle:.1f} {child.x:.1f},{start:.1f} {child.x:.1f},{end:.1f}"
    return (
        f'<path d="{path}" fill="none" stroke="#456" marker-end="url(#tip)"><title>{escape(_origin(joint))}</title>'
        "</path>"
    )


def _label(place: _Node, parent: _Node, child: _Node, joint: Joint) -> str:
    middle = (parent.y + child.y) / 2
    return (
        f'<text x="{place.x:.1f}" y="{middle + 6:.1f}" text-anchor="middle" fill="#1b4f9c" stroke="#fff" '
        f'stroke-width="3" paint-order="stroke">{escape(joint.name)}</text>'
        f'<text x="{place.x:.1f}" y="{middle + 20:.1f}" text-anchor="middle" fill="#789" font-size="10" '
        f'stroke="#fff" stroke-width="3" paint-order="stroke">{joint.type.value}</text>'
    )


def _origin(joint: Joint) -> str:
    xyz = " ".join(f"{value:g}" for value in joint.origin.position)
    rpy = " ".join(f"{round(value, 5) + 0.0:g}" for value in joint.origin.rpy)
    return f"xyz: {xyz} \\nrpy: {rpy}"
