"""Receiving into a buffer only the transforms that hold at all times."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .transform_listener import DEFAULT_STATIC_TF_TOPIC, TransformListener

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.qos import QoSProfile
    from tf2_py import BufferCore


class StaticTransformListener(TransformListener):
    """Listener that inserts the transforms of ``/tf_static`` into a buffer; see `TransformListener`."""

    def __init__(
        self,
        buffer: BufferCore,
        node: Node | None,
        *,
        spin_thread: bool = False,
        static_qos: QoSProfile | int | None = None,
        tf_static_topic: str = DEFAULT_STATIC_TF_TOPIC,
    ) -> None:
        super().__init__(
            buffer,
            node,
            spin_thread=spin_thread,
            static_qos=static_qos,
            tf_static_topic=tf_static_topic,
            static_only=True,
        )
