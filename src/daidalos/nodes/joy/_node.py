"""Common base of the joystick nodes."""

from __future__ import annotations

import sys
import threading
from pathlib import Path
from typing import Any

from rclpy.node import Node
from rclpy.publisher import Publisher
from sensor_msgs.msg import Joy

from daidalos.nodes.joystick import FOLDER, Controls, Joystick, device_name, devices

_RETRY_S = 1.0


class JoystickNode(Node):
    """Node that publishes ``joy`` at changes of a game pad, and periodically in between.

    A thread waits for the game pad's events, also for a game pad that is not there yet or any more.

    Parameters
    ----------
    name
        The node's.
    folder
        Where game pads are.
    """

    def __init__(self, name: str, *, folder: Path = FOLDER, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        if not sys.platform.startswith("linux"):
            raise RuntimeError(
                f"{name} reads the files /dev/input/js* of Linux, which this system has not; "
                "anything else may publish sensor_msgs/msg/Joy on /joy in its stead"
            )
        self.folder = folder
        self.deadzone = self._number("deadzone", 0.05)
        if not 0.0 <= self.deadzone < 1.0:
            raise RuntimeError(f"the parameter 'deadzone' is {self.deadzone}, but must be at least 0 and less than 1")
        self._sticky = bool(self.declare_parameter("sticky_buttons", False).value)
        rate = self._number("autorepeat_rate", 20.0)
        if not 0.0 <= rate <= 1000.0:
            raise RuntimeError(f"the parameter 'autorepeat_rate' is {rate}, but must be from 0 to 1000")
        self._coalesce = self.declare_coalescing()
        self._controls: Controls | None = None
        self._joystick: Joystick | None = None
        self._lock = threading.Lock()
        self._ended = threading.Event()
        self._publisher: Publisher = self.create_publisher(Joy, "joy", 10)
        self._repeat = self.create_timer(1.0 / rate, self._publish) if rate else None
        self._reader = threading.Thread(target=self._read_devices, name="joystick", daemon=True)

    def start(self) -> None:
        """Start to read the device; the parameters must be declared before."""
        self._reader.start()

    def declare_coalescing(self) -> float:
        """Declare for how long axes are waited for, and return it [s]."""
        raise NotImplementedError

    def find(self) -> Path | None:
        """Return the file of the game pad, None while it is not there."""
        raise NotImplementedError

    def _number(self, name: str, default: float) -> float:
        return float(self.declare_parameter(name, default).value)

    def destroy_node(self) -> None:
        """Read no more, and leave the graph."""
        self._ended.set()
        with self._lock:
            if self._joystick is not None:
                self._joystick.wake()
        if self._reader.is_alive():
            self._reader.join()
        super().destroy_node()

    def _read_devices(self) -> None:
        said = ""
        while not self._ended.is_set():
            path = self.find()
            if path is None:
                said = self._say("No game pad is there; waiting for one", said)
            else:
                try:
                    self._read_device(path)
                    continue
                except PermissionError as error:
                    said = self._say(
                        f"The game pad {path} may not be read: {error.strerror}; is it in your group?", said
                    )
                except OSError as error:
                    said = self._say(f"The game pad {path} is gone: {error.strerror or error}", said)
            self._ended.wait(_RETRY_S)

    def _say(self, text: str, said: str) -> str:
        """Log a text unless it was the last one that was logged; returns it."""
        if text != said:
            self.get_logger().info(text)
        return text

    def _read_device(self, path: Path) -> None:
        with Joystick(path) as joystick:
            with self._lock:
                self._joystick = joystick
            self.get_logger().info(f"Opened the game pad {path}: {device_name(path) or 'it does not tell its name'}")
            controls = Controls(self.deadzone, self._sticky)
            try:
                while not self._ended.is_set():
                    events = joystick.read(self._coalesce)
                    with self._lock:
                        for event in events:
                            controls.apply(event)
                        self._controls = controls
                    if events:
                        self._publish()
            finally:
                with self._lock:
                    self._joystick = self._controls = None

    def _publish(self) -> None:
        with self._lock:
            if self._controls is None or self._ended.is_set():
                return
            message = Joy(axes=self._controls.axes, buttons=self._controls.buttons)
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = "joy"
        self._publisher.publish(message)
        if self._repeat is not None:
            self._repeat.reset()


def device_called(name: str, folder: Path) -> Path | None:
    """Return the file of the game pad that has a name, None where there is none."""
    return next((path for path in devices(folder) if device_name(path) == name), None)
