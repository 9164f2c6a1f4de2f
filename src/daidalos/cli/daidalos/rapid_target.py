"""`daidalos rapid run --target`: the next target of an arm as a point on a ROS topic, before the arm moves."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.publisher import Publisher

    from daidalos.common.pose3 import Vector
    from daidalos.industry.rapid.runtime.announced_arm import Announcement


def add_target(parser: argparse.ArgumentParser) -> None:
    """Declare where targets are shown."""
    parser.add_argument(
        "--target", metavar="TOPIC", help="publish each target as a PointStamped before the arm moves there"
    )
    parser.add_argument(
        "--lead", type=float, default=1.0, metavar="S", help="time that a target is shown before (default: 1)"
    )
    parser.add_argument(
        "--target-frame", default="base_link", metavar="FRAME", help="frame of the arm's base (default: base_link)"
    )


@contextmanager
def announcement(args: argparse.Namespace) -> Iterator[Announcement | None]:
    """Yield how targets are shown; None where the arguments name no topic.

    Raises
    ------
    UserError
        Where there is no arm, or the time or the topic's name is none.
    """
    if args.target is None:
        yield None
        return
    if args.robot is None:
        raise UserError("--target needs an arm: add --robot, such as --robot irb120")
    if not 0.0 <= args.lead < 3600.0:
        raise UserError(f"--lead must be from 0 to 3600 s, not {args.lead:g}")
    import rclpy
    from geometry_msgs.msg import PointStamped
    from rclpy.context import Context

    from daidalos.industry.rapid.runtime.announced_arm import Announcement

    context = Context()
    rclpy.init(args=[], context=context)
    node = rclpy.create_node("rapid_target", context=context)
    try:
        publisher = _publisher(node, args.target)

        def show(place: Vector) -> None:
            message = PointStamped()
            message.header.frame_id = args.target_frame
            message.header.stamp = node.get_clock().now().to_msg()
            message.point.x, message.point.y, message.point.z = place
            publisher.publish(message)

        yield Announcement(show, args.lead)
    finally:
        node.destroy_node()
        rclpy.try_shutdown(context=context)


def _publisher(node: Node, topic: str) -> Publisher:
    from geometry_msgs.msg import PointStamped
    from rclpy.exceptions import InvalidTopicNameException

    from daidalos.nodes.qos import LATCHED

    try:
        return node.create_publisher(PointStamped, topic, LATCHED)
    except InvalidTopicNameException as error:
        raise UserError(f"--target: {error}".partition("\n")[0]) from None
