"""Images as arrays, read by Pillow, which only heightmaps and textures need."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.description.errors import DescriptionError


def read_grey(path: Path, where: str = "") -> NDArray[np.float64]:
    """Return an image's brightness.

    Parameters
    ----------
    path : Path
    where : str
        The place in the description, for errors.

    Returns
    -------
    array (rows, columns)
        From 0 to 1, the top row first.

    Raises
    ------
    DescriptionError
        When the file is no image or Pillow is not installed.
    """
    with _open(path, where) as image:
        if image.mode in ("I;16", "I", "F"):
            values = np.asarray(image, dtype=np.float64)
            return values / (65535.0 if image.mode != "F" else max(float(values.max()), 1e-12))
        return np.asarray(image.convert("L"), dtype=np.float64) / 255.0


def read_rgba(path: Path, where: str = "") -> NDArray[np.uint8]:
    """Return an image's colours as an array (rows, columns, 4), the top row first. Errors as `read_grey`."""
    with _open(path, where) as image:
        return np.asarray(image.convert("RGBA"), dtype=np.uint8)


def _open(path: Path, where: str) -> Any:
    try:
        pillow = importlib.import_module("PIL.Image")
    except ImportError:
        raise DescriptionError(f"image {path} needs Pillow: pip install pillow", where) from None
    try:
        image = pillow.open(path)
        image.load()
    except (OSError, ValueError) as problem:
        raise DescriptionError(f"image {path} cannot be read: {problem}", where) from None
    return image
