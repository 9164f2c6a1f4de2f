"""Single pictures of a camera's topic, for a command that asks for them one by one."""

from __future__ import annotations

import math
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Image

from daidalos.common.errors import UserError

TIMEOUT_S = 10.0
"""Time without an image after which there is no camera."""

_IMAGES = 3


class StillCamera:
    """Camera of a topic of `sensor_msgs/msg/Image`, within a ``with`` block.

    Parameters
    ----------
    topic : str
    settle : float
        Time that passes before a picture is taken, in which what it shows comes to rest [s].
    """

    def __init__(self, topic: str, settle: float) -> None:
        import rclpy

        self._topic, self._settle = topic, settle
        self._context = Context()
        rclpy.init(args=[], context=self._context)
        self._node = Node("still_camera", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._images: list[NDArray[np.float64]] = []
        self._problem = ""
        self._node.create_subscription(Image, topic, self._receive, qos_profile_sensor_data)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        import rclpy

        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.try_shutdown(context=self._context)

    def take(self) -> NDArray[np.float64]:
        """Return the mean brightness ``(height, width)`` of a few images that arrive after the time to settle.

        Raises
        ------
        UserError
            When no images come, or they are of an encoding without brightness.
        """
        self._spin(self._settle, math.inf)
        self._images = []
        self._spin(TIMEOUT_S, _IMAGES)
        if self._problem:
            raise UserError(self._problem)
        if len(self._images) < _IMAGES:
            raise UserError(f"{self._topic}: no images come")
        if len({one.shape for one in self._images}) > 1:
            raise UserError(f"{self._topic}: the images change their size")
        return np.asarray(np.mean(self._images, axis=0))

    def _spin(self, seconds: float, count: float) -> None:
        """Receive images for a time, or until so many have come."""
        clock = self._node.get_clock()
        end = clock.now().nanoseconds + int(seconds * 1e9)
        while (left := end - clock.now().nanoseconds) > 0 and len(self._images) < count and not self._problem:
            self._executor.spin_once(timeout_sec=min(left * 1e-9, 0.1))

    def _receive(self, message: Image) -> None:
        try:
            self._images.append(_brightness(message))
        except (ValueError, RuntimeError) as error:
            self._problem = f"{self._topic}: {error}"


def _brightness(message: Image) -> NDArray[np.float64]:
    from cv_bridge import CvBridge

    if message.encoding in ("32FC1", "16UC1"):
        raise ValueError(f"encoding '{message.encoding}' is one of depths; name the topic of a colour or grey image")
    picture: Any = np.asarray(CvBridge().imgmsg_to_cv2(message), dtype=np.float64)
    return np.asarray(picture if picture.ndim == 2 else picture[:, :, :3].mean(axis=2))
