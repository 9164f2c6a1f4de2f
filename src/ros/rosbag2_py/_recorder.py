"""Recording: a node with its thread, the keys of the terminal and the line that shows how far it is."""

from __future__ import annotations

import threading
from typing import ClassVar

from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

from daidalos.bags.errors import BagError
from rosbag2_py._keyboard import SPACE, Keyboard
from rosbag2_py._options import RecordOptions, severity
from rosbag2_py._recorder_node import NODE_NAME, RecorderNode
from rosbag2_py._recorder_services import create_services
from rosbag2_py._storage import StorageOptions


class Recorder:
    """Records topics into a bag.

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
        self._severity = severity(storage_options if isinstance(storage_options, str) else log_level)
        self._failed = False
        self._node: RecorderNode | None = None
        self._context: Context | None = None
        self._executor: SingleThreadedExecutor | None = None
        self._thread: threading.Thread | None = None
        self._keyboard: Keyboard | None = None
        self._cancelled = threading.Event()
        if storage_options is not None and not isinstance(storage_options, str) and record_options is not None:
            self._prepare(storage_options, record_options, node_name)

    def _prepare(self, storage: StorageOptions, options: RecordOptions, node_name: str) -> None:
        self._context = Context()
        self._context.init(args=[])
        try:
            self._node = RecorderNode(storage, options, node_name, self._context, self._on_failure)
        except BaseException:
            self._context.destroy()
            raise
        self._node.get_logger().set_level(self._severity)
        create_services(self._node)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        if not options.disable_keyboard_controls:
            self._keyboard = Keyboard(self._on_key)

    def _configured(self) -> RecorderNode:
        if self._node is None:
            raise RuntimeError("Recorder is not configured: it was made without options")
        return self._node

    @property
    def node(self) -> RecorderNode:
        """The node."""
        return self._configured()

    def _on_key(self, key: str) -> None:
        if key == SPACE and self._node is not None:
            self._node.toggle_paused()

    def _on_failure(self, error: BagError) -> None:
        self._failed = True
        self._cancelled.set()

    @property
    def failed(self) -> bool:
        """Whether the recording ended because it could not go on; the node has said why."""
        return self._failed

    # Step by step.

    def start_spin(self) -> None:
        """Run the node's callbacks in a thread."""
        self._configured()
        if self._thread is None:
            self._thread = threading.Thread(target=self._spin, name="recorder", daemon=True)
            self._thread.start()

    def _spin(self) -> None:
        assert self._executor is not None
        try:
            self._executor.spin()
        except ExternalShutdownException:
            return
        except BaseException:
            self._failed = True
            self._cancelled.set()
            raise

    def stop_spin(self) -> None:
        """Run no more callbacks, and leave the graph."""
        self._configured()
        if self._executor is not None and self._context is not None and self._node is not None:
            self._executor.shutdown()
            if self._thread is not None:
                self._thread.join()
            self._node.destroy_node()
            self._context.destroy()
            self._node = None

    def record(
        self,
        storage_options: StorageOptions | None = None,
        record_options: RecordOptions | None = None,
        node_name: str = NODE_NAME,
    ) -> None:
        """Begin to record; with options, record until `cancel` or Ctrl-C and complete the bag."""
        if storage_options is None or record_options is None:
            self._begin()
            return
        self._prepare(storage_options, record_options, node_name)
        try:
            self.record_sync()
        finally:
            self.stop_spin()

    def _begin(self) -> None:
        node = self._configured()
        self._cancelled.clear()
        Recorder._running.append(self)
        if self._keyboard is not None:
            node.get_logger().info("Press SPACE for pausing/resuming")
            self._keyboard.start()
        try:
            node.record()
        except BaseException:
            self._end_keyboard()
            Recorder._running.remove(self)
            raise

    def record_sync(self) -> None:
        """Record until `cancel` or Ctrl-C, and complete the bag."""
        self._configured()
        self.start_spin()
        self._begin()
        try:
            self.wait()
        finally:
            self.stop()

    def wait(self, timeout_s: float | None = None) -> bool:
        """Wait until the recording is cancelled or fails; False after so many seconds."""
        return self._cancelled.wait(timeout_s)

    def stop(self) -> None:
        """Complete the bag."""
        node = self._configured()
        self._end_keyboard()
        if self in Recorder._running:
            Recorder._running.remove(self)
        node.stop()
        self._cancelled.set()

    def _end_keyboard(self) -> None:
        if self._keyboard is not None:
            self._keyboard.stop()

    def pause(self) -> None:
        """Pass over what comes."""
        self._configured().pause()

    def resume(self) -> None:
        """Record again."""
        self._configured().resume()

    def is_paused(self) -> bool:
        """Tell whether what comes is passed over."""
        return self._configured().is_paused

    @staticmethod
    def cancel() -> None:
        """End every recording of this process."""
        for recorder in list(Recorder._running):
            recorder._cancelled.set()
