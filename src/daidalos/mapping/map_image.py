"""Images of map files: grey values and optional transparency."""

import io
import re
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from daidalos.mapping.errors import MapFileError

Format = Literal["pgm", "png", "bmp"]
Image = NDArray[np.uint8]
Mask = NDArray[np.bool_]


def read_image(path: Path) -> tuple[Image, Mask | None]:
    """Read an image: PGM, or whatever else Pillow reads, such as PNG and BMP.

    Returns
    -------
    grey : array (rows, columns) of uint8
        Grey values, the top row first.
    opaque : array (rows, columns) of bool, or None
        Where it is not transparent; None for an image without transparency.

    Raises
    ------
    MapFileError
        When it cannot be read, naming the part.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise MapFileError(path, None, error.strerror or str(error)) from error
    if content.startswith((b"P2", b"P5")):
        return _read_pgm(path, content), None
    return _read_other(path, content)


def encode_image(grey: Image, opaque: Mask | None, image_format: Format) -> bytes:
    """Return an image as the bytes of a file; only PNG may have transparency."""
    from PIL import Image as pillow

    if image_format == "pgm":
        return f"P5\n{grey.shape[1]} {grey.shape[0]}\n255\n".encode() + grey.tobytes()
    pixels = grey if opaque is None else np.dstack([grey, np.where(opaque, 255, 0).astype(np.uint8)])
    file = io.BytesIO()
    pillow.fromarray(np.ascontiguousarray(pixels)).save(file, image_format.upper())
    return file.getvalue()


def _read_pgm(path: Path, content: bytes) -> Image:
    gap = rb"(?:\s|#[^\n]*\n)+"
    header = re.match(rb"(P[25])" + (gap + rb"(\d{1,9})") * 3 + rb"\s", content)
    if header is None:
        raise MapFileError(path, "header", "expected 'P5' or 'P2', the width, the height and the largest grey value")
    columns, rows, brightest = (int(header.group(k)) for k in (2, 3, 4))
    if not 1 <= brightest <= 255:
        raise MapFileError(path, "header", f"expected a largest grey value from 1 to 255, found {brightest}")
    if rows == 0 or columns == 0:
        raise MapFileError(path, "header", f"expected at least one pixel, found {columns} x {rows}")
    body = content[header.end() :]
    values = _read_text_pixels(path, body) if header.group(1) == b"P2" else np.frombuffer(body, np.uint8)
    if values.size < rows * columns:
        raise MapFileError(path, "pixels", f"expected {columns} x {rows} = {rows * columns}, found {values.size}")
    grey = values[: rows * columns].reshape(rows, columns)
    if brightest == 255:
        return grey
    return np.rint(np.minimum(grey, brightest) * (255.0 / brightest)).astype(np.uint8)


def _read_text_pixels(path: Path, body: bytes) -> Image:
    try:
        values = [int(word) for word in re.sub(rb"#[^\n]*", b"", body).split()]
        return np.array(values, dtype=np.uint8)
    except (ValueError, OverflowError) as error:
        raise MapFileError(path, "pixels", f"expected numbers from 0 to 255: {error}") from error


def _read_other(path: Path, content: bytes) -> tuple[Image, Mask | None]:
    from PIL import Image as pillow

    try:
        with pillow.open(io.BytesIO(content)) as image:
            if image.mode.startswith(("I", "F")):
                raise MapFileError(path, "header", "expected grey values of 8 bits")
            transparent = "A" in image.mode or "transparency" in image.info
            pixels = np.asarray(image.convert("RGBA").convert("LA") if transparent else image.convert("L"))
    # Pillow's readers raise whatever they stumble over.
    except (OSError, ValueError, SyntaxError, pillow.DecompressionBombError) as error:
        raise MapFileError(path, "header", f"expected a PGM, PNG or BMP image: {error}") from error
    return (pixels[..., 0], pixels[..., 1] == 255) if transparent else (pixels, None)
