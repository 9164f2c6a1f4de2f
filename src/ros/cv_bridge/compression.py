"""Compressing images and reading compressed ones, by OpenCV or by Pillow."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._opencv import COMMAND, opencv

Image = NDArray[Any]

_PILLOW_FORMATS = {
    "jpg": "JPEG",
    "jpeg": "JPEG",
    "jpe": "JPEG",
    "jp2": "JPEG2000",
    "tif": "TIFF",
    "pgm": "PPM",
    "pbm": "PPM",
    "pnm": "PPM",
}


def decompress(data: bytes) -> tuple[Image, str]:
    """Return an image, in the order BGR or BGRA if it has colours, and its encoding.

    Raises
    ------
    RuntimeError
        When the data is not an image, or nothing is installed that reads it.
    """
    cv2 = opencv()
    if cv2 is not None:
        image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED) if len(data) else None
        if image is None:
            raise RuntimeError(f"the {len(data)} bytes of data are not a compressed image that OpenCV knows")
    else:
        image = _read_by_pillow(data)
    channels = 1 if image.ndim == 2 else image.shape[2]
    order = {1: "mono", 3: "bgr", 4: "bgra"}[channels]
    return image, f"{order}{8 * image.dtype.itemsize}"


def _read_by_pillow(data: bytes) -> Image:
    pillow = _pillow("reading a compressed image")
    try:
        with pillow.open(BytesIO(data)) as picture:
            if picture.mode.startswith("I;16"):
                return np.array(picture).astype(np.uint16)
            mode = picture.mode if picture.mode in {"L", "RGB", "RGBA"} else "RGBA" if "A" in picture.mode else "RGB"
            if picture.mode == "1":
                mode = "L"
            values = np.array(picture.convert(mode))
    except (OSError, SyntaxError) as error:
        raise RuntimeError(f"the {len(data)} bytes of data are not a compressed image: {error}") from None
    return values if values.ndim == 2 else values[..., [2, 1, 0, 3][: values.shape[2]]]


def compress(image: Image, format_name: str) -> bytes:
    """Return an image, in the order BGR or BGRA if it has colours, compressed.

    Raises
    ------
    RuntimeError
        When the format is unknown or does not take such an image, or nothing is installed that writes it.
    """
    cv2 = opencv()
    if cv2 is None:
        return _write_by_pillow(image, format_name)
    try:
        done, data = cv2.imencode(f".{format_name}", image)
    except cv2.error as error:
        raise RuntimeError(f"cannot write an image of {_shown(image)} as '{format_name}': {error}") from None
    if not done:
        raise RuntimeError(f"cannot write an image of {_shown(image)} as '{format_name}'")
    result: bytes = data.tobytes()
    return result


def _write_by_pillow(image: Image, format_name: str) -> bytes:
    pillow = _pillow("writing a compressed image")
    if image.ndim == 3 and image.shape[2] == 1:
        image = image[..., 0]
    elif image.ndim == 3 and image.shape[2] > 2:
        image = image[..., [2, 1, 0, 3][: image.shape[2]]]
    name = format_name.lower()
    output = BytesIO()
    try:
        pillow.fromarray(np.ascontiguousarray(image)).save(output, format=_PILLOW_FORMATS.get(name, name.upper()))
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise RuntimeError(f"cannot write an image of {_shown(image)} as '{format_name}': {error}") from None
    return output.getvalue()


def _pillow(purpose: str) -> Any:
    try:
        from PIL import Image as pillow
    except ImportError:
        raise RuntimeError(f"{purpose} needs OpenCV or Pillow: {COMMAND}") from None
    return pillow


def _shown(image: Image) -> str:
    return f"shape {image.shape} and type {image.dtype}"
