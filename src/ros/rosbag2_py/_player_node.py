"""The node that plays bags."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from pathlib import Path

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.context import Context
from rclpy.node import Node
from rclpy.qos import QoSProfile

from daidalos.bags.clock import PlaybackClock
from daidalos.bags.errors import BagError
from daidalos.bags.merged import MergedBags
from daidalos.bags.message import BagMessage
from daidalos.bags.read_ahead import ReadAhead
from daidalos.bags.storage import FOREVER_NS
from rosbag2_py._options import PlayOptions
from rosbag2_py._storage import StorageOptions
from rosbag2_py._topic_publishers import TopicPublishers

NODE_NAME = "rosbag2_player"
_SECOND = 1_000_000_000
_DISCOVERY_S = 2.0
RUNNING, PAUSED, BURST, DELAYED, STOPPED = "R", "P", "B", "D", "S"


class PlayerNode(Node):
    """Node that publishes the messages of bags when their time has come.

    One thread plays. Whoever else goes on, jumps or changes the speed does so under the same lock, which the thread
    holds except while it waits.

    Parameters
    ----------
    storage
        The bags.
    options
        How to play them.
    name
        The node's name.
    context
        Its context.

    Raises
    ------
    BagError
        When a bag cannot be read.
    ValueError
        When an option is not valid.
    """

    def __init__(self, storage: Sequence[StorageOptions], options: PlayOptions, name: str, context: Context) -> None:
        self._options = options
        self._selection = options.selection()
        self._selection.check()
        if not options.rate > 0:
            raise ValueError(f"rate: expected a number above 0, found {options.rate}")
        self._bags = MergedBags([(one.uri, one.storage_id) for one in storage], self._publish_file_change)
        try:
            super().__init__(name, context=context, cli_args=_node_arguments(options), use_global_arguments=False)
        except BaseException:
            self._bags.close()
            raise
        for note in self._bags.notes:
            self.get_logger().warning(note)
        self._set_limits()
        self._changed = threading.Condition(threading.RLock())
        self._clock_of_bag = PlaybackClock(self._start, _steady(), options.rate, paused=options.start_paused)
        self._stream: ReadAhead | None = None
        self._message: BagMessage | None = None
        self._playing = False
        self._stopping = False
        self._state = STOPPED
        self._thread: threading.Thread | None = None
        self._began = threading.Event()
        self._finished = threading.Event()
        self.error: BagError | None = None
        self._create_publishers()
        self._declare_range()
        self.get_logger().info(f"Set rate to {options.rate:g}")

    def _set_limits(self) -> None:
        """Set the part of the bag that is played."""
        options = self._options
        offset = round(options.start_offset * _SECOND)
        if offset < 0:
            self.get_logger().warning("Negative start offset ignored.")
            offset = 0
        self._start = self._bags.start_ns + offset
        self._stop = FOREVER_NS
        if options.playback_duration >= 0:
            self._stop = self._start + round(options.playback_duration * _SECOND)
        if options.playback_until_timestamp >= 0:
            self._stop = min(self._stop, options.playback_until_timestamp)

    def _declare_range(self) -> None:
        """Declare read-only parameters with the bag's first and last time, for who shows how far it was played."""
        from rcl_interfaces.msg import ParameterDescriptor

        for name, time_ns in (("bag_start_ns", self._start), ("bag_end_ns", self.end_ns)):
            self.declare_parameter(name, time_ns, ParameterDescriptor(read_only=True))

    def _create_publishers(self) -> None:
        from rosbag2_interfaces.msg import ReadSplitEvent
        from rosgraph_msgs.msg import Clock as ClockMessage

        options = self._options
        wanted = [topic for name, topic in self._bags.topics.items() if self._selection.wants(name, topic.type)]
        self._publishers = TopicPublishers(self, wanted, options)
        self._split_publisher = self.create_publisher(ReadSplitEvent, "events/read_split", 1)
        self._clock_publisher = None
        self._clock_topics: frozenset[str] | None = frozenset(
            name if name.startswith("/") else f"/{name}" for name in options.clock_topics
        )
        if options.clock_publish_on_topic_publish:
            self._clock_topics = None
        if options.clock_publish_frequency > 0 or self._clock_topics is None or self._clock_topics:
            self._clock_publisher = self.create_publisher(ClockMessage, "/clock", QoSProfile(depth=10))
            self._clock_message = ClockMessage()
        if options.clock_publish_frequency > 0:
            self.create_timer(
                1.0 / options.clock_publish_frequency,
                self._tick,
                callback_group=ReentrantCallbackGroup(),
                clock=Clock(clock_type=ClockType.STEADY_TIME),
            )

    # What others want to know.

    @property
    def start_ns(self) -> int:
        """The bag's time at which playing begins."""
        return self._start

    @property
    def end_ns(self) -> int:
        """The bag's time at which playing ends."""
        return min(self._stop, self._bags.end_ns)

    @property
    def state(self) -> str:
        """What is going on, as a letter."""
        if self._state == RUNNING and self._clock_of_bag.paused:
            return PAUSED
        return self._state

    def bag_time(self) -> int:
        """Return the bag's time [ns]."""
        return min(max(self._clock_of_bag.now(_steady()), self._start), max(self.end_ns, self._start))

    # Beginning and ending.

    def play(self) -> bool:
        """Start playing in a thread; return False when it plays already."""
        with self._changed:
            if self._playing:
                self.get_logger().warning("Trying to play rosbag while in playback")
                return False
            if self._thread is not None:
                self._thread.join()
            self._playing, self._stopping = True, False
            self._began.clear()
            self._finished.clear()
            until = self._options.playback_until_timestamp
            self.get_logger().info(f"Playback until timestamp: {until}")
            self._thread = threading.Thread(target=self._run, name="player", daemon=True)
            self._thread.start()
        self._began.wait()
        return True

    def play_part(self, start_offset: float, duration: float, until_ns: int) -> bool:
        """Play a part of the bag; see `PlayOptions`. False when it plays already."""
        with self._changed:
            if self._playing:
                return False
            self._options.start_offset, self._options.playback_duration = start_offset, duration
            self._options.playback_until_timestamp = until_ns
            self._set_limits()
        return self.play()

    def wait_for_start(self, timeout_s: float | None) -> bool:
        """Wait until it plays; False after so many seconds."""
        return self._began.wait(timeout_s)

    def wait_for_end(self, timeout_s: float | None) -> bool:
        """Wait until all was played; False after so many seconds."""
        return self._finished.wait(timeout_s)

    def stop(self) -> None:
        """Play no more."""
        with self._changed:
            self._stopping = True
            self._changed.notify_all()
            thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join()

    def interrupt(self) -> None:
        """Request that playing stops, and nothing else: this may be called by a signal's handler."""
        self._stopping = True

    def destroy_node(self) -> None:
        """Play no more, let the bags go and leave the graph."""
        self.stop()
        self._bags.close()
        super().destroy_node()

    def _run(self) -> None:
        """Play, in the thread: once, or again and again."""
        try:
            self.handle.session.backend.settle(_DISCOVERY_S)
            while True:
                self._delay()
                played = self._play_through()
                if self._stopping or not self._options.loop or not played:
                    break
            if not self._stopping:
                self._publishers.wait_for_all_acked(self._options.wait_acked_timeout)
        except BagError as error:
            self.error = error
            self.get_logger().error(f"Failed to play: {error}")
        finally:
            with self._changed:
                self._playing = False
                self._state = STOPPED
                self._message = None
                self._end_stream()
            self._began.set()
            self._finished.set()

    def _delay(self) -> None:
        with self._changed:
            if self._options.delay > 0:
                self.get_logger().info(f"Sleep {round(self._options.delay * _SECOND)} ns")
                self._state = DELAYED
                self._began.set()
                self._changed.wait_for(lambda: self._stopping, self._options.delay)

    def _play_through(self) -> bool:
        """Play to the end; False where there is nothing to play."""
        with self._changed:
            self._go_to(self._start)
            anything = self._message is not None
            self._state = RUNNING
            self._began.set()
            while self._message is not None and not self._stopping:
                due = self._clock_of_bag.due(self._message.received_ns)
                left = None if due is None else due - _steady()
                if left is None or left > 0:
                    self._changed.wait(None if left is None else left / 1e9)
                else:
                    self._publish_next()
            return anything

    def _go_to(self, time_ns: int) -> None:
        """Continue from a time of the bag."""
        self._end_stream()
        wanted = [name for name in self._publishers.names if name in self._bags.topics]
        messages = self._bags.messages(wanted, start_ns=max(time_ns, 0), stop_ns=self._stop)
        self._stream = ReadAhead(messages, self._options.read_ahead_queue_size)
        self._clock_of_bag.jump(time_ns, _steady())
        self._message = self._stream.next()

    def _end_stream(self) -> None:
        if self._stream is not None:
            self._stream.close()
            self._stream = None

    def _publish_next(self) -> bool:
        """Publish the next message; False at the end. The lock is held."""
        message, stream = self._message, self._stream
        if message is None or stream is None:
            return False
        self._publishers.publish(message)
        if self._clock_publisher is not None and (self._clock_topics is None or message.topic in self._clock_topics):
            self._publish_clock(message.received_ns)
        self._message = stream.next()
        if self._message is None:
            self._changed.notify_all()
        return True

    # Control.

    @property
    def is_paused(self) -> bool:
        """Whether time stands still."""
        return self._clock_of_bag.paused

    @property
    def rate(self) -> float:
        """How fast it plays."""
        return self._clock_of_bag.rate

    def pause(self) -> None:
        """Stop the player's clock."""
        with self._changed:
            self._clock_of_bag.pause(_steady())
            self._changed.notify_all()
        self.get_logger().info("Pausing play.")

    def resume(self) -> None:
        """Continue the player's clock."""
        with self._changed:
            self._clock_of_bag.resume(_steady())
            self._changed.notify_all()
        self.get_logger().info("Resuming play.")

    def toggle_paused(self) -> None:
        """Pause or resume."""
        if self.is_paused:
            self.resume()
        else:
            self.pause()

    def set_rate(self, rate: float) -> bool:
        """Play faster or slower; False when the rate is not above 0."""
        with self._changed:
            try:
                self._clock_of_bag.set_rate(rate, _steady())
            except ValueError:
                self.get_logger().warning(f"Failed to set rate to invalid value {rate:g}")
                return False
            self._changed.notify_all()
        self.get_logger().info(f"Set rate to {rate:g}")
        return True

    def play_next(self) -> bool:
        """Publish the next message while paused; False when it is not paused, or at the end."""
        with self._changed:
            if not self.is_paused:
                self.get_logger().warning("Called play next, but not in paused state.")
                return False
            return self._step()

    def _step(self) -> bool:
        message = self._message
        if message is None:
            return False
        self._publish_next()
        self._clock_of_bag.jump(message.received_ns, _steady())
        return True

    def burst(self, count: int) -> int:
        """Publish so many messages (0: all that are left) at once while paused; returns how many there were."""
        if not self.is_paused:
            self.get_logger().warning("Burst can only be used when in the paused state.")
            return 0
        self.get_logger().info(f"Bursting {count or 'all'} messages.")
        done = 0
        state, self._state = self._state, BURST
        try:
            while (done < count or count == 0) and not self._stopping:
                # The lock is free between two messages: stopping, and those who ask, need not wait for all.
                with self._changed:
                    if not self.is_paused or not self._step():
                        break
                done += 1
        finally:
            if self._state == BURST:
                self._state = state
        self.get_logger().info(f"Burst {done} messages.")
        return done

    def seek(self, time_ns: int) -> bool:
        """Continue from another time of the bag; return False when nothing is played."""
        with self._changed:
            if not self._playing:
                return False
            self._go_to(max(time_ns, self._bags.start_ns))
            self._changed.notify_all()
            return True

    # The clock, events and services.

    def _tick(self) -> None:
        if self._state == RUNNING:  # before, the bag's time has not begun
            self._publish_clock(self._clock_of_bag.now(_steady()))

    def _publish_clock(self, time_ns: int) -> None:
        if self._clock_publisher is not None:
            stamp = self._clock_message.clock
            stamp.sec, stamp.nanosec = divmod(max(time_ns, 0), _SECOND)
            self._clock_publisher.publish(self._clock_message)

    def _publish_file_change(self, closed: Path, opened: Path) -> None:
        from rosbag2_interfaces.msg import ReadSplitEvent

        self._split_publisher.publish(
            ReadSplitEvent(closed_file=str(closed), opened_file=str(opened), node_name=self.get_fully_qualified_name())
        )


def _steady() -> int:
    return time.monotonic_ns()


def _node_arguments(options: PlayOptions) -> list[str]:
    """Return the node's arguments, which programs give with the marker before them."""
    return [word for word in options.topic_remapping_options if word != "--ros-args"]
