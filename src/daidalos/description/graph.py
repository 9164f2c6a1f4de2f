"""A robot's tree as a drawing: an SVG of our own layout, and the same for Graphviz."""

from __future__ import annotations

from dataclasses import dataclass
from xml.sax.saxutils import escape

from daidalos.description.joint import Joint
from daidalos.description.robot import Robot

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


def to_svg(robot: Robot) -> str:
    """Draw links as boxes and joints as the arrows between them, roots on top.

    Each parent stands over the middle of its children, and no two subtrees overlap.
    """
    children: dict[str, list[Joint]] = {}
    for joint in robot.joints.values():
        children.setdefault(joint.parent, []).append(joint)
    nodes, width = _place(robot, children)
    height = max(node.y for node in nodes.values()) + _HEIGHT / 2 + _MARGIN
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
        f'width="{width:.0f}" height="{height:.0f}" font-family="sans-serif" font-size="12">',
        f"<title>{escape(robot.name)}</title>",
        '<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="7" markerHeight="7" '
        'orient="auto"><path d="M0,0 8,4 0,8z" fill="#456"/></marker></defs>',
    ]
    parts += [_arrow(nodes[joint.parent], nodes[joint.child], joint) for joint in robot.joints.values()]
    parts += [_box(node) for node in nodes.values()]
    return "\n".join([*parts, "</svg>"]) + "\n"


def to_dot(robot: Robot) -> str:
    """Return the tree in Graphviz's language, as ``urdf_to_graphviz`` writes it."""
    lines = ["digraph G {", "node [shape=box];"]
    lines += [f'"{link}" [label="{link}"];' for link in robot.links]
    lines.append("node [shape=ellipse, color=blue, fontcolor=blue];")
    for joint in robot.joints.values():
        lines.append(f'"{joint.parent}" -> "{joint.name}" [label="{_origin(joint)}"]')
        lines.append(f'"{joint.name}" -> "{joint.child}"')
    return "\n".join([*lines, "}"]) + "\n"


def _place(robot: Robot, children: dict[str, list[Joint]]) -> tuple[dict[str, _Node], float]:
    """Give every link a place; returns them with the width of the drawing."""
    order = [(robot.root, 0)]
    for name, depth in order:
        order += [(joint.child, depth + 1) for joint in children.get(name, ())]
    own = {name: max(_LETTER * len(name) + 16, 60.0) for name, _ in order}
    # The label of the joint above needs room too.
    label = {joint.child: _LETTER * 0.9 * len(joint.name) + 12 for joint in robot.joints.values()}
    span: dict[str, float] = {}
    for name, _ in reversed(order):
        span[name] = max(own[name], label.get(name, 0.0), _room(children.get(name, []), span))
    left = {robot.root: _MARGIN}
    nodes = {}
    for name, depth in order:
        nodes[name] = _Node(name, left[name] + span[name] / 2, _MARGIN + _HEIGHT / 2 + depth * _LEVEL, own[name])
        start = left[name] + (span[name] - _room(children.get(name, []), span)) / 2
        for joint in children.get(name, []):
            left[joint.child] = start
            start += span[joint.child] + _GAP
    return nodes, span[robot.root] + 2 * _MARGIN


def _room(joints: list[Joint], span: dict[str, float]) -> float:
    """Return the width that children need side by side."""
    return sum(span[joint.child] for joint in joints) + _GAP * max(0, len(joints) - 1)


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
        f'</path><text x="{child.x:.1f}" y="{middle + 6:.1f}" text-anchor="middle" fill="#1b4f9c" stroke="#fff" '
        f'stroke-width="3" paint-order="stroke">{escape(joint.name)}</text>'
        f'<text x="{child.x:.1f}" y="{middle + 20:.1f}" text-anchor="middle" fill="#789" font-size="10" '
        f'stroke="#fff" stroke-width="3" paint-order="stroke">{joint.type.value}</text>'
    )


def _origin(joint: Joint) -> str:
    xyz = " ".join(f"{value:g}" for value in joint.origin.position)
    rpy = " ".join(f"{round(value, 5) + 0.0:g}" for value in joint.origin.rpy)
    return f"xyz: {xyz} \\nrpy: {rpy}"
