"""Task that saves an image of a camera at each waypoint."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import Input, WaypointTask
from daidalos.navigation.errors import TaskFailed

_FORMATS = ("png", "jpg", "jpeg", "bmp", "tiff", "tif", "webp", "ppm", "pgm")


@dataclass(frozen=True)
class PhotoAtWaypointParameters(Parameters):
    """Parameters of the task, by their Nav2 names."""

    enabled: bool = parameter(True, "Whether an image is saved.")
    image_topic: str = parameter(
        "/camera/color/image_raw", "Topic of the camera's images.", not_empty=True, read_only=True
    )
    save_dir: str = parameter(
        "/tmp/waypoint_images", "Folder of the files, which is made where it is missing.", not_empty=True
    )
    image_format: str = parameter("png", "Format of the files.", choices=_FORMATS)


class PhotoAtWaypoint(WaypointTask):
    """Task that saves the last image as ``<index of the waypoint>_<time in seconds>.<format>``."""

    names = ("nav2_waypoint_follower::PhotoAtWaypoint",)
    Parameters = PhotoAtWaypointParameters
    parameters: PhotoAtWaypointParameters
    _index = 0
    _read: Callable[[], Array] | None = None

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Implement `WaypointTask.inputs`."""
        return (Input(self.parameters.image_topic, np.ndarray, self.take),)

    def take(self, read: Callable[[], Array]) -> None:
        """Take an image, as a function that returns its pixels."""
        self._read = read

    def start(self, index: int, pose: Array, now: float) -> None:
        """Implement `WaypointTask.start`."""
        self._index = index

    def step(self, now: float) -> bool:
        """Implement `WaypointTask.step`."""
        p = self.parameters
        if not p.enabled:
            return True
        if self._read is None:
            raise TaskFailed(f"no image has come on '{p.image_topic}'")
        path = Path(p.save_dir).expanduser() / f"{self._index}_{int(now)}.{p.image_format}"
        _save(self._read(), path)
        return True


def _save(pixels: Any, path: Path) -> None:
    """Write an image file.

    Raises
    ------
    TaskFailed
        The folder cannot be made, or the file cannot be written, or its format has no such pixels.
    """
    from PIL import Image

    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        Image.fromarray(pixels).save(path)
    except (OSError, ValueError, TypeError) as error:
        raise TaskFailed(f"the image cannot be saved as '{path}': {error}") from error
