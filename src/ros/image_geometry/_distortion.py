"""Lens distortion by the models of `sensor_msgs/CameraInfo`.

The models are those of D. C. Brown, "Decentering distortion of lenses" (1966), with OpenCV's rational extension, and of
J. Kannala and S. Brandt, "A generic camera model and calibration method" (2006), for fisheye lenses.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_BROWN = ("plumb_bob", "rational_polynomial", "thin_prism", "")
_FISHEYE = ("equidistant", "fisheye")
_STEPS = 50


def distortion(model: str, coefficients: Array) -> Callable[[Array], Array] | None:
    """Return the function that bends ideal rays; None where no ray is bent.

    It takes and returns x / z and y / z of rays in the optical frame, of shape (..., 2).

    Parameters
    ----------
    model
        Such as ``plumb_bob``.
    coefficients
        In OpenCV's order.

    Raises
    ------
    ValueError
        If the model is unknown.
    """
    if not np.any(coefficients):
        return None
    if model in _FISHEYE and len(coefficients) >= 4:
        return lambda rays: _distort_fisheye(rays, coefficients)
    if model in _BROWN and len(coefficients) in (4, 5, 8, 12, 14) and not np.any(coefficients[12:]):
        padded = np.zeros(12)
        padded[: min(len(coefficients), 12)] = coefficients[:12]
        return lambda rays: _distort_brown(rays, padded)
    known = ", ".join(f"'{name}'" for name in (*_BROWN, *_FISHEYE) if name)
    raise ValueError(
        f"the distortion model '{model}' with {len(coefficients)} coefficients is not one of {known}, "
        "with 4 to 12 coefficients"
    )


def undistort(distort: Callable[[Array], Array], bent: Array) -> Array:
    """Return the ideal rays of bent ones, of shape (..., 2), by Newton's method.

    Parameters
    ----------
    bend
        What bent them.
    bent
        x / z and y / z of the bent rays.
    """
    step = 1e-6
    offsets = np.array(((step, 0.0), (0.0, step)))
    rays = bent.copy()
    for _ in range(_STEPS):
        error = bent - distort(rays)
        if not np.any(np.abs(error) > 1e-12):
            break
        # Columns of the Jacobian, (..., 2, 2), by central differences.
        columns = [(distort(rays + offset) - distort(rays - offset)) / (2 * step) for offset in offsets]
        (a, c), (b, d) = (np.moveaxis(column, -1, 0) for column in columns)
        determinant = a * d - b * c
        change = np.stack((d * error[..., 0] - b * error[..., 1], a * error[..., 1] - c * error[..., 0]), axis=-1)
        change = change / determinant[..., np.newaxis]
        # Far outside the picture the models fold back; a bounded step keeps to the side that the picture is on.
        rays = rays + np.clip(change, -0.5, 0.5)
    return rays


def _distort_brown(rays: Array, coefficients: Array) -> Array:
    k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4 = coefficients
    x, y = np.moveaxis(rays, -1, 0)
    r2 = x * x + y * y
    radial = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)))
    return np.stack(
        (
            x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x) + r2 * (s1 + r2 * s2),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y + r2 * (s3 + r2 * s4),
        ),
        axis=-1,
    )


def _distort_fisheye(rays: Array, coefficients: Array) -> Array:
    k1, k2, k3, k4 = coefficients[:4]
    r = np.hypot(rays[..., 0], rays[..., 1])
    theta = np.arctan(r)
    t2 = theta * theta
    bent = theta * (1 + t2 * (k1 + t2 * (k2 + t2 * (k3 + t2 * k4))))
    scale = np.divide(bent, r, out=np.ones_like(r), where=r > 1e-9)
    return np.asarray(rays * scale[..., np.newaxis])
