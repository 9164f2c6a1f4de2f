"""Playing: a node with its thread, the keys of the terminal and the line that shows how far it is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, ClassVar

from daidalos.bags.errors import BagError
from rosbag2_py._keyboard import DOWN, PAGE_DOWN, PAGE_UP, RIGHT, SPACE, UP
from rosbag2_py._options import PlayOptions, severity
from rosbag2_py._player_node import NODE_NAME, PlayerNode
from rosbag2_py._player_services import create_services
from rosbag2_py._progress import StatusLine
from rosbag2_py._running import Runner, RunningNode
from rosbag2_py._storage import StorageOptions

_THREADS = 2
_FASTER = 1.1
_LEAP_NS = 10_000_000_000
_SECOND = 1_000_000_000
_HELP = (
    "Adding keyboard callbacks.",
    "Press SPACE for Pause/Resume",
    "Press CURSOR_RIGHT for Play Next Message",
    "Press CURSOR_UP for Increase Rate 10%",
    "Press CURSOR_DOWN for Decrease Rate 10%",
    "Press PAGE_UP for Seek 10 s Forward",
    "Press PAGE_DOWN for Seek 10 s Backward",
)
_KEYS: dict[str, Callable[[PlayerNode], Any]] = {
    SPACE: PlayerNode.toggle_paused,
    RIGHT: PlayerNode.play_next,
    UP: lambda node: node.set_rate(node.rate * _FASTER),
    DOWN: lambda node: node.set_rate(node.rate / _FASTER),
    PAGE_UP: lambda node: node.seek(node.bag_time() + _LEAP_NS),
    PAGE_DOWN: lambda node: node.seek(node.bag_time() - _LEAP_NS),
}


class Player(Runner[PlayerNode]):
    """Player of bags.

    Made without options, only `play` and `burst` with options can be called, as ROS 2 Jazzy's programs do.

    Parameters
    ----------
    storage_options
        The bag, or several whose messages come in one order by time; or the log level, where nothing else is given.
    play_options
        How to play.
    log_level
        ``debug``, ``info``, ``warn``, ``error`` or ``fatal``.
    node_name
        The node's name.

    Raises
    ------
    RuntimeError
        For an unknown log level or a bag that cannot be read, and by methods where no options were given.
    """

    _running: ClassVar[list[Player]] = []

    def __init__(
        self,
        storage_options: StorageOptions | Sequence[StorageOptions] | str | None = None,
        play_options: PlayOptions | None = None,
        log_level: str = "info",
        node_name: str = NODE_NAME,
    ) -> None:
        super().__init__()
        self._severity = severity(storage_options if isinstance(storage_options, str) else log_level)
        self._status: StatusLine | None = None
        if storage_options is not None and not isinstance(storage_options, str) and play_options is not None:
            self._prepare(_listed(storage_options), play_options, node_name)

    def _prepare(self, storage: Sequence[StorageOptions], options: PlayOptions, node_name: str) -> None:
        self._running_node = RunningNode(
            lambda context: PlayerNode(storage, options, node_name, context),
            self._severity,
            threads=_THREADS,
            keys=None if options.disable_keyboard_controls else _KEYS,
        )
        create_services(self._running_node.node)
        self._status = StatusLine(self._progress, options.progress_bar_update_rate)

    @property
    def _node(self) -> PlayerNode:
        return self._configured.node

    def _progress(self) -> str:
        """Return what is shown while it plays."""
        node = self._node
        now = node.bag_time()
        done, total = (now - node.start_ns) / 1e9, (node.end_ns - node.start_ns) / 1e9
        stamp = f"{now // _SECOND}.{now % _SECOND:09d}"
        return f"[{stamp}] Duration {done:.2f}/{max(total, 0.0):.2f} [{node.state}]"

    # Step by step.

    def play(
        self,
        storage_options: StorageOptions | Sequence[StorageOptions] | None = None,
        play_options: PlayOptions | None = None,
    ) -> None:
        """Start playing; with options, play until the end, `cancel` or Ctrl-C."""
        if storage_options is None or play_options is None:
            self._begin()
            return
        self._prepare(_listed(storage_options), play_options, NODE_NAME)
        try:
            self.play_sync()
        finally:
            self.stop_spin()

    def _begin(self) -> None:
        running = self._configured
        self._cancelled.clear()
        Player._running.append(self)
        running.listen_to_keys(*_HELP)
        running.node.play()
        if self._cancelled.is_set():
            running.node.stop()
        if self._status is not None:
            self._status.start("", "====== Playback Progress ======")

    def play_sync(self) -> None:
        """Play to the end, `cancel` or Ctrl-C."""
        self.start_spin()
        self._begin()
        self._wait_and_stop()

    def _wait_and_stop(self) -> None:
        node = self._node
        try:
            node.wait_for_end(None)
        finally:
            self.stop()
        if node.error is not None:
            raise node.error

    def burst(
        self,
        storage_options: StorageOptions | Sequence[StorageOptions] | int | None = None,
        play_options: PlayOptions | None = None,
        num_messages: int = 0,
    ) -> int:
        """Publish messages (0: all) at once while paused and return their number.

        With options: play from the bag's start, paused, burst so many and go on to the end, `cancel` or Ctrl-C.
        """
        if storage_options is None or isinstance(storage_options, int) or play_options is None:
            count = storage_options if isinstance(storage_options, int) else num_messages
            return self._node.burst(count)
        self._prepare(_listed(storage_options), play_options, NODE_NAME)
        try:
            return self.burst_sync(num_messages)
        finally:
            self.stop_spin()

    def burst_sync(self, num_messages: int) -> int:
        """Play, burst so many messages and go on to the end, `cancel` or Ctrl-C, and return their number."""
        self.start_spin()
        self._begin()
        done = self._node.burst(num_messages)
        self._wait_and_stop()
        return done

    def play_next(self) -> bool:
        """Publish the next message while paused; False when it is not paused, or at the end."""
        return self._node.play_next()

    def pause(self) -> None:
        """Stop the player's clock."""
        self._node.pause()

    def resume(self) -> None:
        """Continue the player's clock."""
        self._node.resume()

    def is_paused(self) -> bool:
        """Return whether time stands still."""
        return self._node.is_paused

    def set_rate(self, rate: float) -> bool:
        """Play faster or slower; False when the rate is not above 0."""
        return self._node.set_rate(rate)

    def get_rate(self) -> float:
        """Return how fast it plays."""
        return self._node.rate

    def seek(self, time_point: int) -> None:
        """Continue from another time of the bag [ns]."""
        self._node.seek(time_point)

    def stop(self) -> None:
        """Play no more."""
        running = self._configured
        if self in Player._running:
            Player._running.remove(self)
        running.node.stop()
        if self._status is not None:
            self._status.stop()
        running.ignore_keys()

    def interrupt(self) -> None:
        """Request that playing stops; for handlers of signals, `stop` is to follow."""
        if self._running_node is not None:
            self._running_node.node.interrupt()

    def wait_for_playback_to_start(self, timeout: float = -1.0) -> bool:
        """Wait until it plays; False after so many seconds (negative: no limit)."""
        return self._node.wait_for_start(timeout if timeout >= 0 else None)

    def wait_for_playback_to_finish(self, timeout: float = -1.0) -> bool:
        """Wait until all was played; False after so many seconds (negative: no limit)."""
        return self._node.wait_for_end(timeout if timeout >= 0 else None)

    @property
    def error(self) -> BagError | None:
        """What ended the playing before its time."""
        return self._node.error

    @staticmethod
    def cancel() -> None:
        """Stop every player of this process."""
        for player in list(Player._running):
            player._cancelled.set()
            if player._running_node is not None:
                player._running_node.node.stop()


def _listed(storage: StorageOptions | Sequence[StorageOptions]) -> Sequence[StorageOptions]:
    """Return the bags that are given, alone or in a list."""
    bags = [storage] if isinstance(storage, StorageOptions) else storage
    if not bags:
        raise RuntimeError("Expected a bag to play, found none")
    return bags
