"""Text in the pixels of a PNG picture, in base64."""

from __future__ import annotations

import math
from base64 import standard_b64decode, standard_b64encode
from io import BytesIO

_PIXEL_BYTES = 3


def encode(string: str) -> bytes:
    """Return a text as the pixels of a picture about as wide as high, filled up with line breaks, in base64."""
    from PIL import Image

    content = string.encode()
    pixels = max(1, math.ceil(len(content) / _PIXEL_BYTES))
    width = max(1, math.isqrt(len(content) // _PIXEL_BYTES))
    height = math.ceil(pixels / width)
    picture = BytesIO()
    Image.frombytes("RGB", (width, height), content.ljust(width * height * _PIXEL_BYTES, b"\n")).save(picture, "png")
    return standard_b64encode(picture.getvalue())


def decode(string: str | bytes) -> str:
    """Return the text of such a picture, without its line breaks."""
    from PIL import Image

    with Image.open(BytesIO(standard_b64decode(string)), formats=("png",)) as picture:
        text: str = picture.convert("RGB").tobytes().decode()
    return text.replace("\n", "")
