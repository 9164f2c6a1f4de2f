"""Recording: a node with its thread, the keys of the terminal and the line that shows how far it is."""

from __future__ import annotations

from typing import ClassVar

from rosbag2_py._keyboard import SPACE
from rosbag2_py._options import RecordOptions, severity
from rosbag2_py._recorder_node import NODE_NAME, RecorderNode
from rosbag2_py._recorder_services import create_services
from rosbag2_py._running import Runner, RunningNode
from rosbag2_py._storage import StorageOptions


class Recorder(Runner[RecorderNode]):
    """Recorder of topics into a bag.

    Made without options, only `record` with options can be called, as ROS 2 Jazzy's programs do.

    Parameters
    ----------
    storage_options
        The bag; or the log level, where nothing else is given.
    record_options
        What to record.
    log_level
        ``debug``, ``info``, ``warn``, ``error`` or ``fatal``.
    node_name
        The node's name.

    Raises
    ------
    RuntimeError
        For an unknown log level, and by methods where no options were given.
    """

    _running: ClassVar[list[Recorder]] = []

    def __init__(
        self,
        storage_options: StorageOptions | str | None = None,
        record_options: RecordOptions | None = None,
        log_level: str = "info",
        node_name: str = NODE_NAME,
    ) -> None:
        super().__init__()
        # Called on an object, it also ends a recording that is about to start.
        self.cancel = self._cancelled.set  # type: ignore[method-assign]
        self._severity = severity(storage_options if isinstance(storage_options, str) else log_level)
        self._failed = False
        if storage_options is not None and not isinstance(storage_options, str) and record_options is not None:
            self._prepare(storage_options, record_options, node_name)

    def _prepare(self, storage: StorageOptions, options: RecordOptions, node_name: str) -> None:
        self._running_node = RunningNode(
            lambda context: RecorderNode(storage, options, node_name, context, self._fail),
            self._severity,
            keys=None if options.disable_keyboard_controls else {SPACE: RecorderNode.toggle_paused},
            on_crash=self._fail,
        )
        create_services(self._running_node.node)

    @property
    def node(self) -> RecorderNode:
        """The node."""
        return self._configured.node

    def _fail(self) -> None:
        self._failed = True
        self._cancelled.set()

    @property
    def failed(self) -> bool:
        """Whether the recording ended because it could not go on; the node has said why."""
        return self._failed

    # Step by step.

    def record(
        self,
        storage_options: StorageOptions | None = None,
        record_options: RecordOptions | None = None,
        node_name: str = NODE_NAME,
    ) -> None:
        """Start recording; with options, record until `cancel` or Ctrl-C and complete the bag."""
        if storage_options is None or record_options is None:
            self._begin()
            return
        self._prepare(storage_options, record_options, node_name)
        try:
            self.record_sync()
        finally:
            self.stop_spin()

    def _begin(self) -> None:
        running = self._configured
        Recorder._running.append(self)
        running.listen_to_keys("Press SPACE for pausing/resuming")
        try:
            running.node.record()
        except BaseException:
            running.ignore_keys()
            Recorder._running.remove(self)
            raise

    def record_sync(self) -> None:
        """Record until `cancel` or Ctrl-C, and complete the bag."""
        self.start_spin()
        self._begin()
        try:
            self.wait()
        finally:
            self.stop()
            self._cancelled.clear()

    def wait(self, timeout_s: float | None = None) -> bool:
        """Wait until the recording is cancelled or fails; False after so many seconds."""
        return self._cancelled.wait(timeout_s)

    def stop(self) -> None:
        """Complete the bag."""
        running = self._configured
        running.ignore_keys()
        if self in Recorder._running:
            Recorder._running.remove(self)
        running.node.stop()
        self._cancelled.set()

    def pause(self) -> None:
        """Ignore what comes."""
        self.node.pause()

    def resume(self) -> None:
        """Record again."""
        self.node.resume()

    def is_paused(self) -> bool:
        """Return whether what comes is passed over."""
        return self.node.is_paused

    @staticmethod
    def cancel() -> None:
        """Stop every recorder of this process."""
        for recorder in list(Recorder._running):
            recorder._cancelled.set()
