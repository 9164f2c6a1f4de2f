"""Program beside the player of a failure's bag: it shows the true world and its robots among what the nodes published.

``python -m daidalos.testing.replay FOLDER`` publishes the shapes of all models on ``/world``, and the frames of their
links below the frame ``world``, from the ``link_states`` that are played. The robot's own tree of frames is attached
where the robot was at first, so that what it believes and what is true can be compared.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.serialization import deserialize_message
from std_msgs.msg import Header

from daidalos.bags.reader import BagReader
from daidalos.common.pose3 import Pose
from daidalos.common.rate_gate import RateGate
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import UserError, program_arguments, run
from daidalos.testing.kept_world import read_world

STATES = "/gazebo/link_states"
FRAME = "world"
_RATE = 25.0
_ALL_AGAIN = 25
"""After how many messages links that stand still are sent again: a page forgets them when a bag restarts."""

_STILL = 1e-6


class WorldReplay(Node):
    """Node that publishes the world of a failure while its bag is played.

    Parameters
    ----------
    folder : Path
        Of the failure.

    Raises
    ------
    UserError
        When it has no world.
    """

    def __init__(self, folder: Path) -> None:
        super().__init__("scenario_world", parameter_overrides=[Parameter("use_sim_time", value=True)])
        from gazebo_msgs.msg import LinkStates
        from tf2_ros import StaticTransformBroadcaster, TransformBroadcaster
        from visualization_msgs.msg import MarkerArray

        shapes = read_world(folder)
        if shapes is None:
            raise UserError(f"there is no world in '{folder}'")
        for marker in shapes.markers:
            marker.frame_locked = True
        self._frames = TransformBroadcaster(self)
        self._gate = RateGate(_RATE)
        self._sent: dict[str, Pose] = {}
        self._count = 0
        StaticTransformBroadcaster(self).sendTransform(
            [_stamped(above, below, pose, None) for above, below, pose in attachments(folder / "bag")]
        )
        self._shapes = self.create_publisher(MarkerArray, "/world", LATCHED)
        self._shapes.publish(shapes)
        self.create_subscription(LinkStates, STATES, self._on_states, 10)

    def _on_states(self, states: Any) -> None:
        now = self.get_clock().now()
        if not self._gate.is_due(now.nanoseconds):
            return
        if self._count % _ALL_AGAIN == 0:
            self._sent.clear()
        self._count += 1
        moved = [
            (name, pose)
            for name, pose in _link_poses(states)
            if (before := self._sent.get(name)) is None or _is_elsewhere(pose, before)
        ]
        self._sent.update(moved)
        if moved:
            self._frames.sendTransform([_stamped(FRAME, name, pose, now.to_msg()) for name, pose in moved])


def attachments(bag: Path) -> list[tuple[str, str, Pose]]:
    """Return what attaches the frames of a bag to the true world, from the first true poses of the links in them.

    Parameters
    ----------
    bag : Path
        With transforms, and ``link_states`` of a simulator. A frame is that of a link by its name, or by that of the
        model, a slash and its name.

    Returns
    -------
    list of (str, str, Pose)
        Frame above, frame below, and where that is: the roots of the trees in the world, and the sensors' and other
        links' frames of which the bag has no transform.

    Raises
    ------
    BagError
        When it cannot be read.
    """
    from gazebo_msgs.msg import LinkStates
    from tf2_msgs.msg import TFMessage

    parents: dict[str, tuple[str, Pose]] = {}
    placed: dict[str, Pose] = {}
    links: dict[str, Pose] = {}
    is_changed = True
    with BagReader(bag) as reader:
        for message in reader.messages({"/tf", "/tf_static", STATES} & set(reader.topics)):
            if message.topic != STATES:
                for one in deserialize_message(message.data, TFMessage).transforms:
                    is_changed |= one.child_frame_id not in parents
                    parents[one.child_frame_id] = one.header.frame_id, _pose_of_transform(one.transform)
            elif is_changed:
                links = dict(_link_poses(deserialize_message(message.data, LinkStates)))
                found = _roots(parents, links)
                placed = found | placed
                is_changed = not found
    roots = [(FRAME, root, pose) for root, pose in placed.items() if root not in parents and root != FRAME]
    names = Counter(name.partition("::")[2] for name in links)
    unknown = [(name, link) for name in links if names[link := name.partition("::")[2]] == 1]
    return roots + [(name, link, Pose()) for name, link in unknown if link not in parents and link not in placed]


def _roots(parents: dict[str, tuple[str, Pose]], links: dict[str, Pose]) -> dict[str, Pose]:
    """Return where the roots of frames are in the world, by the first link below each."""
    found: dict[str, Pose] = {}
    for name, true in links.items():
        model, _, link = name.partition("::")
        frame = next((frame for frame in (f"{model}/{link}", link) if frame in parents), None)
        below = Pose()
        climbed = 0
        while frame in parents and climbed <= len(parents):
            frame, pose = parents[frame]
            below = pose @ below
            climbed += 1
        if frame is not None:
            found.setdefault(frame, true @ below.inverse)
    return found


def _link_poses(states: Any) -> Iterator[tuple[str, Pose]]:
    for name, pose in zip(states.name, states.pose, strict=True):
        if "::" in name:
            p, q = pose.position, pose.orientation
            yield name, Pose((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))


def _is_elsewhere(pose: Pose, before: Pose) -> bool:
    values, others = (*pose.position, *pose.orientation), (*before.position, *before.orientation)
    return any(abs(value - other) > _STILL for value, other in zip(values, others, strict=True))


def _pose_of_transform(transform: Any) -> Pose:
    p, q = transform.translation, transform.rotation
    return Pose((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))


def _stamped(parent: str, child: str, pose: Pose, stamp: Any) -> TransformStamped:
    (x, y, z), (qx, qy, qz, qw) = pose.position, pose.orientation
    header = Header(frame_id=parent) if stamp is None else Header(frame_id=parent, stamp=stamp)
    transform = Transform(translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw))
    return TransformStamped(header=header, child_frame_id=child, transform=transform)


def main() -> int:
    """Run the node beside the player of a folder's bag."""
    (folder,) = program_arguments()
    return run(lambda: WorldReplay(Path(folder)))


if __name__ == "__main__":
    sys.exit(main())
