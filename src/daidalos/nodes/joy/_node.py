"""Common base of the joystick nodes."""

from __future__ import annotations

import sys
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rclpy.node import Node
from rclpy.publisher import Publisher
from sensor_msgs.msg import Joy

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.joystick import FOLDER, Controls, Joystick, device_name, devices
from daidalos.nodes.parameters import declare

_RETRY_S = 1.0


@dataclass(frozen=True)
class JoystickParameters(Parameters):
    """Common parameters of the joystick nodes."""

    deadzone: float = parameter(0.05, "Share of an axis that counts as its centre.", minimum=0.0, below=1.0)
    autorepeat_rate: float = parameter(
        20.0, "Rate at which an unchanged state is published; 0 for never.", unit="Hz", minimum=0.0, maximum=1000.0
    )
    sticky_buttons: bool = parameter(False, "Whether a button changes its state at each press.")

    @property
    def coalescing_s(self) -> float:
        """For how long axes that move together are waited for [s]."""
        raise NotImplementedError


class JoystickNode(Node):
    """Node that publishes ``joy`` at changes of a game pad, and periodically in between.

    A thread waits for the game pad's events, also for a game pad that is not there yet or any more.

    Parameters
    ----------
    name
        The node's.
    parameters
        The class of its parameters.
    folder
        Where game pads are.
    """

    def __init__(
        self, name: str, parameters: type[JoystickParameters], *, folder: Path = FOLDER, **kwargs: Any
    ) -> None:
        super().__init__(name, **kwargs)
        if not sys.platform.startswith("linux"):
            raise RuntimeError(
                f"{name} reads the files /dev/input/js* of Linux, which this system has not; "
                "anything else may publish sensor_msgs/msg/Joy on /joy in its stead"
            )
        self.folder = folder
        self.settings: Any = declare(self, parameters)
        rate = self.settings.autorepeat_rate
        self._controls: Controls | None = None
        self._joystick: Joystick | None = None
        self._lock = threading.Lock()
        self._ended = threading.Event()
        self._publisher: Publisher = self.create_publisher(Joy, "joy", 10)
        self._repeat = self.create_timer(1.0 / rate, self._publish) if rate else None
        self._reader = threading.Thread(target=self._read_devices, name="joystick", daemon=True)
        self._reader.start()

    def find(self) -> Path | None:
        """Return the file of the game pad, None while it is not there."""
        raise NotImplementedError

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
            controls = Controls(self.settings.deadzone, self.settings.sticky_buttons)
            try:
                while not self._ended.is_set():
                    events = joystick.read(self.settings.coalescing_s)
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
