"""Receiving transforms into a buffer."""

from __future__ import annotations

from threading import Thread
from typing import TYPE_CHECKING, Any

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from tf2_msgs.msg import TFMessage
from tf2_py._history import History
from tf2_py.buffer_core import SharedEntries

from ._inbox import create_inbox
from .buffer import Buffer

if TYPE_CHECKING:
    from tf2_py import BufferCore

DEFAULT_TF_TOPIC = "/tf"
DEFAULT_STATIC_TF_TOPIC = "/tf_static"
_AUTHORITY = "default_authority"
_SHARED = SharedEntries()


class TransformListener:
    """Listener that inserts the transforms of ``/tf`` and ``/tf_static`` into a buffer, without an executor.

    Parameters
    ----------
    buffer
        Where to put them. A buffer that follows no node's clock yet will follow this node's.
    node
        The node to subscribe with; where None, one is made.
    spin_thread
        Whether a thread of the listener's spins the node.
    qos, static_qos
        Quality of service; a number means KEEP_LAST with that depth.
    tf_topic, tf_static_topic
        Where to listen for transforms that change, and for those that hold at all times.
    static_only
        Whether to listen for the latter only.
    """

    def __init__(
        self,
        buffer: BufferCore,
        node: Node | None,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
        tf_topic: str = DEFAULT_TF_TOPIC,
        tf_static_topic: str = DEFAULT_STATIC_TF_TOPIC,
        static_only: bool = False,
    ) -> None:
        if qos is None:
            qos = QoSProfile(depth=100, durability=DurabilityPolicy.VOLATILE, history=HistoryPolicy.KEEP_LAST)
        if static_qos is None:
            static_qos = QoSProfile(
                depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL, history=HistoryPolicy.KEEP_LAST
            )
        self.buffer = buffer
        if node is None:
            node = self._own_node()
        elif isinstance(buffer, Buffer):
            buffer.follow(node)
        self.node = node
        self.group = ReentrantCallbackGroup()
        # Who replaces how messages are taken or inserted gets each of them.
        own = type(self).callback is TransformListener.callback and type(buffer).set_transform is Buffer.set_transform
        if not static_only:
            take = self._insert if own else self.callback
            self.tf_sub = create_inbox(node, TFMessage, tf_topic, take, qos, self.group)
        self.tf_static_sub = create_inbox(
            node, TFMessage, tf_static_topic, self.static_callback, static_qos, self.group
        )
        if spin_thread:
            self.executor = SingleThreadedExecutor(context=node.context)
            self.executor.add_node(node)
            self.dedicated_listener_thread = Thread(target=_spin, args=(self.executor,), daemon=True)
            self.dedicated_listener_thread.start()

    def _own_node(self) -> Node:
        return Node(
            f"transform_listener_impl_{id(self):010x}",
            enable_rosout=False,
            start_parameter_services=False,
            parameter_overrides=[Parameter("use_sim_time", value=False)],
        )

    def __del__(self) -> None:
        if hasattr(self, "dedicated_listener_thread"):
            self.executor.shutdown()
        self.unregister()

    def unregister(self) -> None:
        """Receive no more."""
        for name in ("tf_sub", "tf_static_sub"):
            if hasattr(self, name):
                self.node.destroy_subscription(getattr(self, name))

    def _insert(self, data: Any) -> None:
        self.buffer._insert(_SHARED.of(data, _AUTHORITY), _AUTHORITY, History)

    def callback(self, data: Any) -> None:
        """Insert the transforms of a ``tf2_msgs/msg/TFMessage`` into the buffer."""
        for transform in data.transforms:
            self.buffer.set_transform(transform, _AUTHORITY)

    def static_callback(self, data: Any) -> None:
        """Insert transforms that hold at all times into the buffer."""
        for transform in data.transforms:
            self.buffer.set_transform_static(transform, _AUTHORITY)


def _spin(executor: SingleThreadedExecutor) -> None:
    try:
        executor.spin()
    except ExternalShutdownException:
        return  # the end of the program
