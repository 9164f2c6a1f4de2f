"""Rigid motions as tuples of floats: ``(x, y, z, qx, qy, qz, qw)``, rotation first, then translation.

One flat tuple: for one transform at a time it is several times faster than an array or an object.
"""

from __future__ import annotations

from collections.abc import Iterable

from daidalos.common.pose3 import rotate, slerp

Rigid = tuple[float, float, float, float, float, float, float]
IDENTITY: Rigid = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def compose(outer: Rigid, inner: Rigid) -> Rigid:
    """Return the motion that does `inner`, then `outer`."""
    ox, oy, oz, a, b, c, d = outer
    x, y, z, e, f, g, h = inner
    # v + 2 u × (u × v + d v), with the rotation's vector part u = (a, b, c)
    i = 2.0 * (b * z - c * y)
    j = 2.0 * (c * x - a * z)
    k = 2.0 * (a * y - b * x)
    return (
        x + d * i + b * k - c * j + ox,
        y + d * j + c * i - a * k + oy,
        z + d * k + a * j - b * i + oz,
        d * e + a * h + b * g - c * f,
        d * f + b * h + c * e - a * g,
        d * g + c * h + a * f - b * e,
        d * h - a * e - b * f - c * g,
    )


def inverse(motion: Rigid) -> Rigid:
    """Return the motion that undoes another."""
    x, y, z, a, b, c, d = motion
    px, py, pz = rotate((-a, -b, -c, d), (x, y, z))
    return (-px, -py, -pz, -a, -b, -c, d)


def chain(motions: Iterable[Rigid]) -> Rigid:
    """Return the motion that does all of these, the first one first."""
    result: Rigid | None = None
    for motion in motions:
        result = motion if result is None else compose(motion, result)
    return IDENTITY if result is None else result


def interpolate(one: Rigid, two: Rigid, ratio: float) -> Rigid:
    """Return the motion on the way from `one` (ratio 0) to `two` (ratio 1): linear, and along the shorter arc."""
    ax, ay, az = one[:3]
    bx, by, bz = two[:3]
    rest = 1.0 - ratio
    return (
        rest * ax + ratio * bx,
        rest * ay + ratio * by,
        rest * az + ratio * bz,
        *slerp(one[3:], two[3:], ratio),
    )


def canonical(motion: Rigid) -> Rigid:
    """Return the same motion with the quaternion, of the two that there are, that tf2 reports.

    Its w is positive where the rotation is below 120 degrees, and otherwise its largest vector component is.
    """
    x, y, z, a, b, c, d = motion
    if d > 0.5:
        return motion
    leading = d if d < -0.5 else max(a, b, c, key=abs)
    return motion if leading >= 0.0 else (x, y, z, -a, -b, -c, -d)
