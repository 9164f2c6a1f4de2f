"""Converting arrays between encodings: by OpenCV where it is installed, else by numpy with the same results."""

from __future__ import annotations

import colorsys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._opencv import COMMAND, opencv
from .encodings import Encoding, encoding

Image = NDArray[Any]

_COLOURS = ("mono", "rgb", "bgr", "rgba", "bgra")
_YUV = ("uyvy", "yuyv")
# OpenCV's Bayer patterns are named after the second row and column of the sensor.
_BAYER = {"bayer_rggb": "BayerBG", "bayer_bggr": "BayerRG", "bayer_gbrg": "BayerGR", "bayer_grbg": "BayerGB"}
# Rec. 601 luma in units of 2^-15, and the inverse for studio-range YUV in units of 2^-20, as OpenCV rounds them.
_LUMA = {"r": 9798, "g": 19235, "b": 3735}
_LUMA_BITS = 15
_Y, _V_TO_R, _U_TO_G, _V_TO_G, _U_TO_B = 1220542, 1673527, -409993, -852492, 2116026
_YUV_BITS = 20
_GOLDEN = 0.6180339887498949


def cvtColor2(image: Image, encoding_in: str, encoding_out: str) -> Image:
    """Return an image in another encoding.

    Parameters
    ----------
    image
        Of shape (height, width) or (height, width, channels).
    encoding_in, encoding_out
        The encodings; an empty one means that of the image.

    Raises
    ------
    RuntimeError
        When there is no such encoding, or no such conversion.
    """
    source = encoding(encoding_in)
    if not encoding_out or encoding_out == encoding_in:
        return image.copy()
    target = encoding(encoding_out)
    _check(source, target, encoding_in, encoding_out)
    result = (
        _convert_channels(image, source, target, encoding_in, encoding_out) if source.order and target.order else image
    )
    return _change_depth(result, source, target)


def _check(source: Encoding, target: Encoding, name_in: str, name_out: str) -> None:
    """Check that a conversion is possible."""
    if not source.order and target.order:
        raise RuntimeError(
            f"[{name_in}] is not a color format. but [{name_out}] is. The conversion does not make sense"
        )
    if not (source.order and target.order) and source.channels != target.channels:
        if source.order:
            raise RuntimeError(
                f"[{name_in}] is a color format but [{name_out}] is not so they must have the same OpenCV type, "
                "CV_8UC3, CV16UC1 ...."
            )
        raise RuntimeError(f"[{name_in}] and [{name_out}] do not have the same number of channel")


def _convert_channels(image: Image, source: Encoding, target: Encoding, name_in: str, name_out: str) -> Image:
    """Return the image with the target's channels, in the source's depth."""
    if source.order == target.order:
        return image
    if target.order not in _COLOURS:
        raise RuntimeError(f"Unsupported conversion from [{name_in}] to [{name_out}]")
    if source.order in _BAYER:
        if opencv() is None:
            raise RuntimeError(f"converting from [{name_in}] to [{name_out}] needs OpenCV: {COMMAND}")
        return _by_opencv(image, f"{_BAYER[source.order]}2{_opencv_name(target.order)}")
    if opencv() is not None:
        return _by_opencv(image, f"{_opencv_name(source.order)}2{_opencv_name(target.order)}{_suffix(source.order)}")
    return _by_numpy(image, source.order, target.order)


def _opencv_name(order: str) -> str:
    return {"mono": "GRAY", "uyvy": "YUV", "yuyv": "YUV"}.get(order, order.upper())


def _suffix(order: str) -> str:
    return {"uyvy": "_UYVY", "yuyv": "_YUY2"}.get(order, "")


def _by_opencv(image: Image, code: str) -> Image:
    cv2 = opencv()
    result: Image = cv2.cvtColor(image, getattr(cv2, f"COLOR_{code}"))
    return result


def _by_numpy(image: Image, source: str, target: str) -> Image:
    if source in _YUV:
        if target == "mono":
            return np.ascontiguousarray(image[..., source.index("y")])
        image, source = _rgb_from_yuv(image, source), "rgb"
    if source == "mono":
        colour = np.repeat(image.reshape(*image.shape[:2], 1), len(target), axis=2)
        if "a" in target:
            colour[..., 3] = _opaque(image.dtype)
        return colour
    if target == "mono":
        # Sums of 16 bits times 15 fit into 32 bits without a sign.
        total = np.full(image.shape[:2], 1 << (_LUMA_BITS - 1), np.uint32)
        for channel, weight in _LUMA.items():
            total += np.uint32(weight) * image[..., source.index(channel)]
        return (total >> _LUMA_BITS).astype(image.dtype)
    result = np.empty((*image.shape[:2], len(target)), image.dtype)
    for place, channel in enumerate(target):
        result[..., place] = image[..., source.index(channel)] if channel in source else _opaque(image.dtype)
    return result


def _opaque(dtype: np.dtype[Any]) -> int:
    return int(np.iinfo(dtype).max)


def _rgb_from_yuv(image: Image, order: str) -> Image:
    """Return RGB of YUV 4:2:2 in studio range (Rec. 601); two neighbours share their colour."""
    wide = image.shape[1] - image.shape[1] % 2
    chroma = image[:, :wide, 1 - order.index("y")].astype(np.int64) - 128
    u, v = (np.repeat(chroma[:, first::2], 2, axis=1) for first in (0, 1))
    luma = np.maximum(image[:, :wide, order.index("y")].astype(np.int64) - 16, 0) * _Y + (1 << (_YUV_BITS - 1))
    channels = (luma + _V_TO_R * v, luma + _U_TO_G * u + _V_TO_G * v, luma + _U_TO_B * u)
    return np.stack([np.clip(one >> _YUV_BITS, 0, 255) for one in channels], axis=-1).astype(np.uint8)


def _change_depth(image: Image, source: Encoding, target: Encoding) -> Image:
    """Return the image in the target's depth; 8 and 16 bits are scaled into each other's range."""
    if source.dtype == target.dtype:
        return image
    bits = (8 * source.dtype.itemsize, 8 * target.dtype.itemsize)
    scale = {(8, 16): 65535.0 / 255.0, (16, 8): 255.0 / 65535.0}.get(bits, 1.0)
    values = image.astype(np.float64) * scale
    if target.dtype.kind == "f":
        return values.astype(target.dtype)
    limits = np.iinfo(target.dtype)
    return np.clip(np.rint(values), limits.min, limits.max).astype(target.dtype)


def cvtColorForDisplay(
    image: Image,
    encoding_in: str,
    encoding_out: str,
    do_dynamic_scaling: bool = False,
    min_image_value: float = 0.0,
    max_image_value: float = 0.0,
    colormap: int = -1,
    bg_label: int = -1,
) -> Image:
    """Return an image that people can look at.

    Labels (32SC1) get a colour each; depths and other numbers are scaled to what can be seen; colours are converted.

    Parameters
    ----------
    image
        Of shape (height, width) or (height, width, channels).
    encoding_in
        Its encoding.
    encoding_out
        An encoding of 8 bits; bgr8, or mono8 for an image of one channel that holds no labels, when empty.
    do_dynamic_scaling
        Whether the smallest value becomes black and the largest white.
    min_image_value, max_image_value
        The values that become black and white otherwise, when they differ.
    colormap
        OpenCV's number of a map of colours to apply to an image of one channel; none when negative.
    bg_label
        The label that stays black.

    Raises
    ------
    RuntimeError
        When there is no such encoding, or no such conversion.
    """
    source = encoding(encoding_in)
    target_name = encoding_out or ("bgr8" if source.channels > 1 or encoding_in == "32SC1" else "mono8")
    target = encoding(target_name)
    if target.dtype != np.uint8 or target.order not in _COLOURS:
        raise RuntimeError(
            f"cv_bridge.cvtColorForDisplay() does not have an output encoding that is color or mono: [{target_name}]"
        )
    if encoding_in == "32SC1":
        return cvtColor2(_colours_of_labels(image, bg_label), "bgr8", target_name)
    name = encoding_in
    if do_dynamic_scaling or min_image_value != max_image_value or colormap >= 0:
        image = _scaled(image, None if do_dynamic_scaling else (min_image_value, max_image_value))
        name = "mono8" if source.channels == 1 else "bgr8"
    elif not source.order:
        name = _name_by_channels(source, encoding_in)
    if colormap >= 0:
        image, name = _coloured(image, colormap), "bgr8"
    return cvtColor2(image, name, target_name)


def _name_by_channels(source: Encoding, name: str) -> str:
    """Return the encoding that plain numbers are taken for."""
    bits = 8 * source.dtype.itemsize
    order = {1: "mono", 3: "bgr", 4: "bgra"}.get(source.channels)
    if order is None or source.dtype.kind != "u":
        raise RuntimeError(f"Unsupported conversion from [{name}] to an image for display; ask for scaling")
    return f"{order}{bits}"


def _scaled(image: Image, limits: tuple[float, float] | None) -> Image:
    """Return an image scaled to 0 ... 255; what is not finite becomes black."""
    values = image.astype(np.float64)
    known = np.isfinite(values)
    if limits is None or limits[0] == limits[1]:
        limits = (float(values[known].min()), float(values[known].max())) if known.any() else (0.0, 0.0)
    low, high = limits
    scaled = (values - low) * (255.0 / (high - low)) if high > low else np.zeros_like(values)
    return np.clip(np.rint(np.where(known, scaled, 0.0)), 0, 255).astype(np.uint8)


def _coloured(image: Image, colormap: int) -> Image:
    cv2 = opencv()
    if cv2 is None:
        raise RuntimeError(f"a map of colours needs OpenCV: {COMMAND}")
    result: Image = cv2.applyColorMap(image, colormap)
    return result


def _colours_of_labels(labels: Image, background: int) -> Image:
    """Return a BGR image with a colour for every label; neighbouring numbers get hues far apart."""
    found, places = np.unique(labels, return_inverse=True)
    palette = np.array(
        [
            (0, 0, 0)
            if label == background
            else [round(255 * part) for part in colorsys.hsv_to_rgb(label * _GOLDEN % 1, 1, 1)][::-1]
            for label in found.tolist()
        ],
        np.uint8,
    )
    return palette[places.reshape(labels.shape)]
