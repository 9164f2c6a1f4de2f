"""Colours of deviations, and pictures of them for reports."""

from __future__ import annotations

import base64
import io

import numpy as np
from numpy.typing import NDArray

_COLOURS = np.array(
    [[0.13, 0.30, 0.75], [0.35, 0.65, 0.95], [0.55, 0.80, 0.55], [0.98, 0.75, 0.25], [0.80, 0.12, 0.12]]
)
"""From below the target (blue) over on the target (green) to above it (red)."""
_OUTSIDE = 0.55
_MAX_EDGE = 420


def deviation_colors(excess: NDArray[np.float64], span: float) -> NDArray[np.uint8]:
    """Return the colours (..., 3) of deviations from -span, blue, over 0, green, to span, red [m]."""
    at = np.clip((excess / span + 1.0) * 0.5, 0.0, 1.0) * (len(_COLOURS) - 1)
    low = np.minimum(at.astype(np.int64), len(_COLOURS) - 2)
    share = (at - low)[..., None]
    colors: NDArray[np.uint8] = np.round(255.0 * (_COLOURS[low] * (1.0 - share) + _COLOURS[low + 1] * share)).astype(
        np.uint8
    )
    return colors


def deviation_picture(excess: NDArray[np.float64], region: NDArray[np.bool_], span: float, title: str) -> str:
    """Return a picture of a deviation map as an HTML figure, y upwards; cells outside of the region are grey."""
    from PIL import Image

    every = -(-max(excess.shape) // _MAX_EDGE)
    colors = deviation_colors(excess[::every, ::every], span)
    colors[~region[::every, ::every]] = round(255 * _OUTSIDE)
    stream = io.BytesIO()
    Image.fromarray(colors[::-1]).save(stream, "PNG")
    data = base64.b64encode(stream.getvalue()).decode()
    caption = f"{title}; blue: {1e6 * span:.0f} um below the target, green: on it, red: {1e6 * span:.0f} um above"
    return (
        f'<figure style="display:inline-block;margin:0 1em 1em 0"><img alt="{title}" '
        f'src="data:image/png;base64,{data}"><figcaption style="max-width:420px">{caption}</figcaption></figure>'
    )
