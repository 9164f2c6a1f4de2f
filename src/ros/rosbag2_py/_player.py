"""Playing: a node with its thread, the keys of the terminal and the line that shows how far it is."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Any, ClassVar

from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor

from daidalos.bags.errors import BagError
from rosbag2_py._keyboard import DOWN, PAGE_DOWN, PAGE_UP, RIGHT, SPACE, UP, Keyboard
from rosbag2_py._options import PlayOptions, severity
from rosbag2_py._player_node import NODE_NAME, PlayerNode
from rosbag2_py._player_services import create_services
from rosbag2_py._progress import StatusLine
from rosbag2_py._storage import StorageOptions

_THREADS = 2
_FASTER = 1.1
_LEAP_NS = 10_000_000_000
_SECOND = 1_000_000_000


class Player:
    """Plays a bag.

    Made without options, only `play` and `burst` with options can be called, as ROS 2 Jazzy's programs do.

    Parameters
    ----------
    storage_options
        The bag; or the log level, where nothing else is given.
    play_options
        How to play it.
    log_level
        ``debug``, ``info``, ``warn``, ``error`` or ``fatal``.
    node_name
        The node's name.

    Raises
    ------
    RuntimeError
        For an unknown log level or a bag that can not be read, and by methods where no options were given.
    """

    _running: ClassVar[list[Player]] = []

    def __init__(
        self,
        storage_options: StorageOptions | Sequence[StorageOptions] | str | None = None,
        play_options: PlayOptions | None = None,
        log_level: str = "info",
        node_name: str = NODE_NAME,
    ) -> None:
        self._severity = severity(storage_options if isinstance(storage_options, str) else log_level)
        self._node: PlayerNode | None = None
        self._context: Context | None = None
        self._executor: MultiThreadedExecutor | None = None
        self._thread: threading.Thread | None = None
        self._keyboard: Keyboard | None = None
        self._status: StatusLine | None = None
        self._cancelled = threading.Event()
        if storage_options is not None and not isinstance(storage_options, str) and play_options is not None:
            self._prepare(_only(storage_options), play_options, node_name)

    def _prepare(self, storage: StorageOptions, options: PlayOptions, node_name: str) -> None:
        self._options = options
        self._context = Context()
        self._context.init(args=[])
        try:
            self._node = PlayerNode(storage, options, node_name, self._context)
        except BaseException:
            self._context.destroy()
            raise
        self._node.get_logger().set_level(self._severity)
        create_services(self._node)
        self._executor = MultiThreadedExecutor(_THREADS, context=self._context)
        self._executor.add_node(self._node)
        if not options.disable_keyboard_controls:
            self._keyboard = Keyboard(self._on_key)
        self._status = StatusLine(self._progress, options.progress_bar_update_rate)

    def _configured(self) -> PlayerNode:
        if self._node is None:
            raise RuntimeError("Player is not configured: it was made without options")
        return self._node

    def _on_key(self, key: str) -> None:
        node = self._node
        if node is None:
            return
        actions: dict[str, Callable[[], Any]] = {
            SPACE: node.toggle_paused,
            RIGHT: node.play_next,
            UP: lambda: node.set_rate(node.rate * _FASTER),
            DOWN: lambda: node.set_rate(node.rate / _FASTER),
            PAGE_UP: lambda: node.seek(node.bag_time() + _LEAP_NS),
            PAGE_DOWN: lambda: node.seek(node.bag_time() - _LEAP_NS),
        }
        actions[key]()

    def _progress(self) -> str:
        """Return what is shown while it plays."""
        node = self._configured()
        now = node.bag_time()
        done, total = (now - node.start_ns) / 1e9, (node.end_ns - node.start_ns) / 1e9
        stamp = f"{now // _SECOND}.{now % _SECOND:09d}"
        return f"[{stamp}] Duration {done:.2f}/{max(total, 0.0):.2f} [{node.state}]"

    # Step by step.

    def start_spin(self) -> None:
        """Run the node's callbacks in a thread."""
        self._configured()
        if self._thread is None:
            self._thread = threading.Thread(target=self._spin, name="player callbacks", daemon=True)
            self._thread.start()

    def _spin(self) -> None:
        assert self._executor is not None
        try:
            self._executor.spin()
        except ExternalShutdownException:
            return

    def stop_spin(self) -> None:
        """Run no more callbacks, and leave the graph."""
        node = self._configured()
        if self._executor is not None and self._context is not None:
            self._executor.shutdown()
            if self._thread is not None:
                self._thread.join()
            node.close()
            node.destroy_node()
            self._context.destroy()
            self._node = None

    def play(
        self,
        storage_options: StorageOptions | Sequence[StorageOptions] | None = None,
        play_options: PlayOptions | None = None,
    ) -> None:
        """Begin to play; with options, play to the end, `cancel` or Ctrl-C."""
        if storage_options is None or play_options is None:
            self._begin()
            return
        self._prepare(_only(storage_options), play_options, NODE_NAME)
        try:
            self.play_sync()
        finally:
            self.stop_spin()

    def _begin(self) -> None:
        node = self._configured()
        self._cancelled.clear()
        Player._running.append(self)
        if self._keyboard is not None:
            for line in (
                "Adding keyboard callbacks.",
                "Press SPACE for Pause/Resume",
                "Press CURSOR_RIGHT for Play Next Message",
                "Press CURSOR_UP for Increase Rate 10%",
                "Press CURSOR_DOWN for Decrease Rate 10%",
                "Press PAGE_UP for Seek 10 s Forward",
                "Press PAGE_DOWN for Seek 10 s Backward",
            ):
                node.get_logger().info(line)
            self._keyboard.start()
        node.play()
        if self._cancelled.is_set():
            node.stop()
        if self._status is not None:
            self._status.start("", "====== Playback Progress ======")

    def play_sync(self) -> None:
        """Play to the end, `cancel` or Ctrl-C."""
        self._configured()
        self.start_spin()
        self._begin()
        self._wait_and_stop()

    def _wait_and_stop(self) -> None:
        node = self._configured()
        try:
            node.wait_for_end(None)
        finally:
            self.stop()
        if node.error is not None:
            raise node.error

    def burst(
        self,
        storage_options: StorageOptions | int | None = None,
        play_options: PlayOptions | None = None,
        num_messages: int = 0,
    ) -> int:
        """Publish messages (0: all) at once while paused and return their number.

        With options: play from the bag's start, paused, burst so many and go on to the end, `cancel` or Ctrl-C.
        """
        if not isinstance(storage_options, StorageOptions) or play_options is None:
            count = storage_options if isinstance(storage_options, int) else num_messages
            return self._configured().burst(count)
        self._prepare(storage_options, play_options, NODE_NAME)
        try:
            return self.burst_sync(num_messages)
        finally:
            self.stop_spin()

    def burst_sync(self, num_messages: int) -> int:
        """Play, burst so many messages and go on to the end, `cancel` or Ctrl-C; returns their number."""
        node = self._configured()
        self.start_spin()
        self._begin()
        done = node.burst(num_messages)
        self._wait_and_stop()
        return done

    def play_next(self) -> bool:
        """Publish the next message while paused; False when it is not paused, or at the end."""
        return self._configured().play_next()

    def pause(self) -> None:
        """Let time stand still."""
        self._configured().pause()

    def resume(self) -> None:
        """Let time go on."""
        self._configured().resume()

    def is_paused(self) -> bool:
        """Tell whether time stands still."""
        return self._configured().is_paused

    def set_rate(self, rate: float) -> bool:
        """Play faster or slower; False when the rate is not above 0."""
        return self._configured().set_rate(rate)

    def get_rate(self) -> float:
        """Return how fast it plays."""
        return self._configured().rate

    def seek(self, time_point: int) -> None:
        """Go on from another time of the bag [ns]."""
        self._configured().seek(time_point)

    def stop(self) -> None:
        """Play no more."""
        node = self._configured()
        if self in Player._running:
            Player._running.remove(self)
        node.stop()
        if self._status is not None:
            self._status.stop()
        if self._keyboard is not None:
            self._keyboard.stop()

    def interrupt(self) -> None:
        """Note that playing is to stop; for handlers of signals, `stop` is to follow."""
        node = self._node
        if node is not None:
            node.interrupt()

    def wait_for_playback_to_start(self, timeout: float = -1.0) -> bool:
        """Wait until it plays; False after so many seconds (negative: no limit)."""
        return self._configured().wait_for_start(timeout if timeout >= 0 else None)

    def wait_for_playback_to_finish(self, timeout: float = -1.0) -> bool:
        """Wait until all was played; False after so many seconds (negative: no limit)."""
        return self._configured().wait_for_end(timeout if timeout >= 0 else None)

    @property
    def error(self) -> BagError | None:
        """What ended the playing before its time."""
        return self._configured().error

    @staticmethod
    def cancel() -> None:
        """End every playing of this process."""
        for player in list(Player._running):
            player._cancelled.set()
            if player._node is not None:
                player._node.stop()


def _only(storage: StorageOptions | Sequence[StorageOptions]) -> StorageOptions:
    """Return the bag that is given, alone or in a list."""
    if isinstance(storage, StorageOptions):
        return storage
    if len(storage) != 1:
        raise RuntimeError(f"Expected one bag to play, found {len(storage)}; join them with `ros2 bag convert`")
    return storage[0]
