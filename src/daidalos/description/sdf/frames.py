"""SDF's frame semantics: poses relative to named frames, resolved to one root.

Follows the "Pose frame semantics" proposal of SDF 1.7 and its additions up to 1.11.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from daidalos.common.pose3 import Pose, normalize
from daidalos.description.markup import Element


@dataclass(frozen=True)
class RelativePose:
    """Pose as written; `relative_to` is empty if the file does not name a frame."""

    pose: Pose = field(default_factory=Pose)
    relative_to: str = ""


def read_pose(parent: Element, tag: str = "pose") -> RelativePose:
    """Read ``<pose>`` of an element: Euler angles, degrees or quaternion, and ``relative_to``."""
    element = parent.first(tag)
    if element is None:
        return RelativePose()
    relative_to = element.attribute("relative_to", element.attribute("frame", ""))
    if not element.text.strip():
        return RelativePose(Pose(), relative_to)
    if element.attribute("rotation_format", "euler_rpy") == "quat_xyzw":
        x, y, z, qx, qy, qz, qw = element.vector(7)
        if qx == qy == qz == qw == 0:
            raise element.error("the quaternion is zero")
        return RelativePose(Pose((x, y, z), normalize((qx, qy, qz, qw))), relative_to)
    numbers = element.vector(6)
    unit = 0.017453292519943295 if element.attribute("degrees", "false") in ("true", "1") else 1.0
    return RelativePose(Pose.from_xyz_rpy(numbers[:3], tuple(a * unit for a in numbers[3:])), relative_to)


class FrameGraph:
    """Named frames, each placed in another one, resolved to the root.

    Parameters
    ----------
    root : str
        Name of the root: ``__model__`` or ``world``.
    """

    def __init__(self, root: str) -> None:
        self.root = root
        self._placed: dict[str, tuple[RelativePose, str, Element]] = {}
        self._resolved: dict[str, Pose] = {root: Pose()}
        self._stand_ins: set[str] = set()

    def __contains__(self, name: str) -> bool:
        return name == self.root or name in self._placed

    def can_place(self, name: str) -> bool:
        """Return whether a frame is known, or lies in a model that was not found."""
        return name in self or bool(self._stand_in(name))

    def add(self, name: str, pose: RelativePose, default: str, element: Element) -> None:
        """Add a frame; `default` is its parent if the file names none.

        Raises
        ------
        DescriptionError
            When the name is taken.
        """
        if name in self:
            raise element.error(f"the name {name!r} is used before in the same scope")
        self._placed[name] = (pose, pose.relative_to or default, element)

    def add_stand_in(self, name: str, pose: RelativePose, element: Element) -> None:
        """Add a frame for a model that was not found; frames inside it are taken to be where it is."""
        self.add(name, pose, self.root, element)
        self._stand_ins.add(name)

    def pose(self, name: str, element: Element) -> Pose:
        """Return the pose of a frame in the root.

        Raises
        ------
        DescriptionError
            When there is no such frame or frames are placed in a circle; `element` asked for it.
        """
        chain: list[str] = []
        name = self._stand_in(name) or name
        while name not in self._resolved:
            if name in chain:
                circle = " -> ".join([*chain[chain.index(name) :], name])
                raise element.error(f"frames are placed in a circle: {circle}")
            if name not in self._placed:
                asker = self._placed[chain[-1]][2] if chain else element
                raise asker.error(f"there is no frame {name!r}; known are {', '.join(self.names())}")
            chain.append(name)
            name = self._placed[name][1]
            name = self._stand_in(name) or name
        for child in reversed(chain):
            relative, parent, _ = self._placed[child]
            self._resolved[child] = self._resolved[self._stand_in(parent) or parent] @ relative.pose
        return self._resolved[chain[0] if chain else name]

    def _stand_in(self, name: str) -> str:
        """Return the stand-in for the model that a frame is in; empty for a known frame."""
        model = name.partition("::")[0]
        return model if name not in self._placed and model in self._stand_ins else ""

    def place(self, relative: RelativePose, default: str, element: Element) -> Pose:
        """Return a pose, relative to any frame, in the frame `default`."""
        if not relative.relative_to or relative.relative_to == default:
            return relative.pose
        return self.pose(default, element).inverse @ self.pose(relative.relative_to, element) @ relative.pose

    def names(self) -> list[str]:
        """Return all frame names in file order."""
        return list(self._placed)
