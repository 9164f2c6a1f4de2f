"""Publishing transforms that hold at all times."""

from __future__ import annotations

from collections.abc import Iterable
from copy import deepcopy
from typing import TYPE_CHECKING

from rclpy.impl.lazy_reexport import lazy_reexport
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from .transform_broadcaster import as_list

if TYPE_CHECKING:
    from geometry_msgs.msg import TransformStamped
    from rclpy.node import Node


class StaticTransformBroadcaster:
    """Publisher of transforms on ``/tf_static``; late subscriptions get all of them.

    Parameters
    ----------
    node
        The node to publish with.
    qos
        Quality of service; a number means KEEP_LAST with that depth.
    """

    def __init__(self, node: Node, qos: QoSProfile | int | None = None) -> None:
        if qos is None:
            qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, history=HistoryPolicy.KEEP_LAST)
        self.pub_tf = node.create_publisher(TFMessage, "/tf_static", qos)
        self._sent: dict[str, TransformStamped] = {}

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:
        """Publish a transform, or several, with all that were sent before: the topic keeps one message only."""
        self._sent.update((one.child_frame_id, deepcopy(one)) for one in as_list(transform))
        self.pub_tf.publish(TFMessage(transforms=list(self._sent.values())))


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__,
        {"geometry_msgs.msg": ("TransformStamped",)},
    )
