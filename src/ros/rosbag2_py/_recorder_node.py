"""The node that records topics into a bag."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.context import Context
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from daidalos.bags.cache import SnapshotBuffer, WriterThread
from daidalos.bags.errors import BagError
from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.writer import BagWriter
from daidalos.transport.graph import EndpointInfo, EndpointKind, NodeInfo
from daidalos.transport.qos import incompatibilities
from rosbag2_py._message_definitions import definition_of
from rosbag2_py._options import RecordOptions
from rosbag2_py._storage import StorageOptions
from rosbag2_py._types import message_class, opaque_class

NODE_NAME = "rosbag2_recorder"
_DEPTH = 1000
"""How many messages of a topic may wait for the thread that takes them."""
_KINDS = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
_DISCOVERY_S = 2.0


class RecorderNode(Node):
    """Node that subscribes to the wanted topics, as they appear, and writes them to a bag.

    Parameters
    ----------
    storage
        The bag.
    options
        What is recorded.
    name
        The node's name.
    context
        Its context.
    on_failure
        Called when the bag cannot be written any more.

    Raises
    ------
    ValueError
        When a regular expression is none.
    """

    def __init__(
        self,
        storage: StorageOptions,
        options: RecordOptions,
        name: str,
        context: Context,
        on_failure: Callable[[], None],
    ) -> None:
        self._selection = options.selection()
        self._selection.check()
        overrides: list[Parameter[Any]] = []
        if options.use_sim_time:
            overrides.append(Parameter("use_sim_time", value=True))
        super().__init__(name, context=context, parameter_overrides=overrides, use_global_arguments=False)
        self._storage = storage
        self._options = options
        self._on_failure = on_failure
        self._use_sim_time = options.use_sim_time
        self._paused = options.start_paused
        self._bag: BagWriter | None = None
        self._sink: WriterThread | SnapshotBuffer | None = None
        self._subscribed: dict[str, Any] = {}
        self._warned: set[object] = set()
        self._discovering = False
        self._stop_listening: Callable[[], None] | None = None
        self._changing = threading.RLock()
        self._group = MutuallyExclusiveCallbackGroup()
        self._look = self.create_guard_condition(self._discover, callback_group=self._group)

    # Beginning and ending.

    @property
    def is_recording(self) -> bool:
        """Whether a bag is open."""
        return self._bag is not None

    @property
    def bag(self) -> BagWriter | None:
        """The bag that is open."""
        return self._bag

    def record(self, uri: str = "") -> None:
        """Open a bag and subscribe to the topics that exist.

        Raises
        ------
        BagError
            When the bag cannot be made.
        RuntimeError
            When one is recorded already.
        """
        with self._changing:
            if self._bag is not None:
                raise RuntimeError("Recording is already in progress.")
            folder = Path(uri or self._storage.uri)
            options = self._storage.writer_options(self._options.compression())
            self._bag = BagWriter(folder, options, self._publish_split)
            if self._storage.snapshot_mode:
                self._sink = SnapshotBuffer(self._bag, self._storage.max_cache_size)
            else:
                self._sink = WriterThread(self._bag, self._storage.max_cache_size, self._fail)
            self._create_split_publisher()
        logger = self.get_logger()
        logger.info(f"Starting recording to '{folder}'")
        logger.info("Listening for topics...")
        self.start_discovery()
        logger.info("Recording...")

    def stop(self) -> None:
        """Complete the bag; nothing is recorded any more."""
        with self._changing:
            bag, sink = self._bag, self._sink
            if bag is None or sink is None:
                return
            self.get_logger().info("Pausing recording.")
            self.stop_discovery()
            self._take_pending()
            for subscription in self._subscribed.values():
                self.destroy_subscription(subscription)
            self._subscribed.clear()
            get_logger("rosbag2_cpp").info("Writing remaining messages from cache to the bag. It may take a while")
            sink.close()
            try:
                bag.close()
            except BagError as error:
                self._fail(error)
            self._report_losses(sink)
            self._bag = self._sink = None
            self.get_logger().info("Recording stopped")

    def _take_pending(self) -> None:
        """Record the messages that have come but were not taken yet."""
        for subscription in self._subscribed.values():
            for _ in range(len(subscription.handle.impl)):
                waiting = subscription._rcl_take()
                if waiting is not None:
                    callback, arguments = waiting
                    callback(*arguments)

    def _report_losses(self, sink: WriterThread | SnapshotBuffer) -> None:
        if sink.lost:
            topics = ", ".join(f"{topic}: {count}" for topic, count in sorted(sink.lost.items()))
            get_logger("rosbag2_cpp").warning(
                f"Cache buffers lost messages per topic: {topics}. Total lost: {sink.lost.total()}"
            )

    def _fail(self, error: BagError) -> None:
        self.get_logger().error(str(error))
        self._on_failure()

    # Control.

    @property
    def is_paused(self) -> bool:
        """Whether what comes is passed over."""
        return self._paused

    def pause(self) -> None:
        """Ignore what comes from now on."""
        self._paused = True
        self.get_logger().info("Pausing recording.")

    def resume(self) -> None:
        """Record again."""
        self._paused = False
        self.get_logger().info("Resuming recording.")

    def toggle_paused(self) -> None:
        """Pause or resume."""
        if self._paused:
            self.resume()
        else:
            self.pause()

    def split(self) -> None:
        """Start the next file of the bag."""
        bag, sink = self._bag, self._sink
        if bag is not None and sink is not None:
            sink.call(bag.split)

    @property
    def keeps_snapshots(self) -> bool:
        """Whether messages are kept in memory until a snapshot is asked for."""
        return self._storage.snapshot_mode

    def take_snapshot(self) -> bool:
        """Write what was kept in snapshot mode."""
        self._take_pending()
        sink = self._sink
        return isinstance(sink, SnapshotBuffer) and sink.take()

    # Finding topics.

    @property
    def is_discovering(self) -> bool:
        """Whether topics that appear are looked at."""
        return self._discovering

    def start_discovery(self) -> None:
        """Subscribe to what is there and, unless that is not wanted, to what appears."""
        with self._changing:
            if self._discovering or self._bag is None:
                return
            self.get_logger().info("Topics discovery started.")
            self._discovering = True
            if not self._options.is_discovery_disabled:
                self._stop_listening = self.handle.graph.listen(self._on_graph_change)
        self.handle.session.backend.settle(_DISCOVERY_S)
        self._discover()
        if self._options.is_discovery_disabled:
            self.stop_discovery()

    def stop_discovery(self) -> None:
        """Ignore topics that appear from now on."""
        with self._changing:
            if not self._discovering:
                return
            self._discovering = False
            if self._stop_listening:
                self._stop_listening()
                self._stop_listening = None
            self.get_logger().info("Topics discovery stopped.")

    def _on_graph_change(self, added: bool, what: NodeInfo | EndpointInfo) -> None:
        if added and isinstance(what, EndpointInfo) and what.kind in _KINDS:
            self._look.trigger()

    def _discover(self) -> None:
        """Subscribe to what is wanted and there."""
        with self._changing:
            if not self._discovering or self._bag is None:
                return
            for name, endpoints in sorted(self._present().items()):
                publishers = [one for one in endpoints if one.kind is EndpointKind.PUBLISHER]
                if name in self._subscribed:
                    self._check_publishers(name, publishers)
                else:
                    self._consider(name, endpoints, publishers)
            wanted = self._selection.names
            if wanted is not None and all(name in self._subscribed for name in wanted):
                self.get_logger().info("All requested topics are subscribed. Stopping discovery...")
                self.stop_discovery()

    def _present(self) -> dict[str, list[EndpointInfo]]:
        found: dict[str, list[EndpointInfo]] = {}
        for endpoint in self.handle.graph.endpoints(*_KINDS):
            found.setdefault(endpoint.name, []).append(endpoint)
        return found

    def _consider(self, name: str, endpoints: list[EndpointInfo], publishers: list[EndpointInfo]) -> None:
        options = self._options
        type_names = sorted({one.type_name for one in endpoints})
        if not any(self._selection.wants(name, one) for one in type_names):
            return
        if not publishers and not options.include_unpublished_topics:
            return
        listened_to = len(endpoints) > len(publishers)
        if options.ignore_leaf_topics and not listened_to:
            return
        if len(type_names) > 1:
            self._warn_once(
                name,
                f"Topic '{name}' has more than one type associated. Only topics with one type are supported. "
                f"Types: {', '.join(type_names)}",
            )
            return
        type_hash = next((one.type_hash for one in endpoints if one.type_hash), "")
        self._subscribe(name, type_names[0], type_hash, publishers)

    def _subscribe(self, name: str, type_name: str, type_hash: str, publishers: list[EndpointInfo]) -> None:
        bag = self._bag
        if bag is None or self._sink is None:
            return
        kind = message_class(type_name)
        definition = definition_of(type_name)
        if kind is None or (type_hash and type_hash != kind._TYPE_HASH):
            what = "an unknown type" if kind is None else "another definition of the type"
            self.get_logger().warning(
                f"Topic '{name}' has {what} '{type_name}' associated; it is recorded without its definition"
            )
            kind, definition = opaque_class(type_name, type_hash), None
        qos = self._qos_for(name, publishers)
        topic = Topic(
            name, type_name, "cdr", tuple(one.qos for one in publishers), type_hash or kind._TYPE_HASH, definition
        )
        self._sink.call(lambda: bag.add_topic(topic))
        self._subscribed[name] = self.create_subscription(
            kind, name, self._taker(name), qos, callback_group=self._group, raw=True
        )
        self.get_logger().info(f"Subscribed to topic '{name}'")

    def _taker(self, name: str) -> Callable[[bytes, Any], None]:
        """Return the function that is called with every message of a topic."""
        sink = self._sink
        assert sink is not None
        write = sink.write
        use_clock = self._use_sim_time
        clock = self.get_clock()

        def take(data: bytes, info: Any) -> None:
            if self._paused:
                return
            received = info["received_timestamp"]
            if use_clock:
                received = clock.now().nanoseconds
                if received == 0:
                    return
            write(BagMessage(name, data, received, info["source_timestamp"]))

        return take

    def _qos_for(self, name: str, publishers: list[EndpointInfo]) -> QoSProfile:
        """Return the strictest profile that matches every publisher, unless another is requested."""
        override = self._options.topic_qos_profile_overrides.get(name)
        if override is not None:
            self.get_logger().info(f"Overriding subscription profile for {name}")
            return override
        reliable = all(one.qos.reliable for one in publishers)
        latched = all(one.qos.transient_local for one in publishers) and bool(publishers)
        if not reliable and any(one.qos.reliable for one in publishers):
            self.get_logger().warning(
                f'Some, but not all, publishers on topic "{name}" are offering ReliabilityPolicy.RELIABLE. '
                "Falling back to BEST_EFFORT as it will connect to all publishers. "
                "Some messages from Reliable publishers could be dropped."
            )
        return QoSProfile(
            depth=max([_DEPTH, *(one.qos.depth for one in publishers)]),
            reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        )

    def _check_publishers(self, name: str, publishers: list[EndpointInfo]) -> None:
        """Log the publishers that came later and do not match the subscription."""
        requested = self._subscribed[name].qos_profile.resolved()
        for publisher in publishers:
            policies = incompatibilities(publisher.qos, requested)
            if policies:
                self._warn_once(
                    publisher.gid,
                    f"A new publisher for subscribed topic {name} was found offering another "
                    f"{', '.join(policy.name for policy in policies)} than rosbag2 already subscribed requesting. "
                    "Messages from this new publisher will not be recorded.",
                )

    def _warn_once(self, key: object, text: str) -> None:
        if key not in self._warned:
            self._warned.add(key)
            self.get_logger().warning(text)

    # Events.

    def _create_split_publisher(self) -> None:
        from rosbag2_interfaces.msg import WriteSplitEvent

        if not hasattr(self, "_split_publisher"):
            self._split_publisher = self.create_publisher(WriteSplitEvent, "events/write_split", 1)

    def _publish_split(self, closed: Path, opened: Path) -> None:
        from rosbag2_interfaces.msg import WriteSplitEvent

        self._split_publisher.publish(
            WriteSplitEvent(closed_file=str(closed), opened_file=str(opened), node_name=self.get_fully_qualified_name())
        )
