"""Tree of links of robots and models, for printing and drawing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from daidalos.description.joint import Joint
from daidalos.description.robot import Robot
from daidalos.description.world import Model

_WORLD = "world"


@dataclass(frozen=True)
class LinkTree:
    """Links with their child links.

    Parameters
    ----------
    roots : tuple of str
        Links that hang on none, among them ``world`` when joints of a model hang on it.
    children : mapping
        The joints below each link; every link is the child of one of them, or a root.
    closing : tuple of Joint
        Joints to a link that hangs on another one already: they close loops.
    """

    roots: tuple[str, ...]
    children: Mapping[str, tuple[Joint, ...]]
    closing: tuple[Joint, ...]


def link_tree(description: Robot | Model) -> LinkTree:
    """Return the links as trees; if several joints have the same child, the first one counts."""
    above: dict[str, Joint] = {}
    for joint in description.joints.values():
        above.setdefault(joint.child, joint)
    links = list(description.links)
    if _WORLD not in links and any(joint.parent == _WORLD for joint in description.joints.values()):
        links.insert(0, _WORLD)
    roots = [link for link in links if link not in above]
    reached: set[str] = set()
    _reach(roots, above, reached)
    for link in links:
        if link not in reached:  # all that is left goes round in circles: cut there
            del above[link]
            roots.append(link)
            _reach([link], above, reached)
    children: dict[str, list[Joint]] = {}
    for joint in above.values():
        children.setdefault(joint.parent, []).append(joint)
    return LinkTree(
        tuple(roots),
        {link: tuple(joints) for link, joints in children.items()},
        tuple(joint for joint in description.joints.values() if above.get(joint.child) is not joint),
    )


def _reach(start: list[str], above: Mapping[str, Joint], reached: set[str]) -> None:
    """Add the descendants of links to `reached`."""
    below: dict[str, list[str]] = {}
    for link, joint in above.items():
        below.setdefault(joint.parent, []).append(link)
    waiting = list(start)
    while waiting:
        link = waiting.pop()
        if link not in reached:
            reached.add(link)
            waiting += below.get(link, [])
