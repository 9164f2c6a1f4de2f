"""Functions of vectors, rotations, frames, twists and wrenches."""

from __future__ import annotations

from typing import Any

from PyKDL.frames import Frame, Rotation, Twist, Vector, Wrench


def dot(first: Any, second: Any) -> float:
    """Return the scalar product of two vectors, or the power of a twist and a wrench."""
    if isinstance(first, Vector):
        return float(sum(a * b for a, b in zip(first, second, strict=True)))
    twist, wrench = (first, second) if isinstance(first, Twist) else (second, first)
    return dot(twist.vel, wrench.force) + dot(twist.rot, wrench.torque)


def diff(first: Any, second: Any, dt: float = 1.0) -> Any:
    """Return the change in a time [s]: a twist of frames, the axis times the rate of rotations."""
    if isinstance(first, Frame):
        return Twist(diff(first.p, second.p, dt), diff(first.M, second.M, dt))
    if isinstance(first, Rotation):
        return first * (first.Inverse() * second).GetRot() / dt
    return (second - first) / dt


def addDelta(first: Any, change: Any, dt: float = 1.0) -> Any:
    """Return what a change, as `diff` returns it, makes of something in a time [s]."""
    if isinstance(first, Frame):
        return Frame(addDelta(first.M, change.rot, dt), addDelta(first.p, change.vel, dt))
    if isinstance(first, Rotation):
        local = first.Inverse() * change * dt
        angle = local.Norm()
        return first * (Rotation.Rot(local, angle) if angle > 0.0 else Rotation())
    return first + change * dt


def Equal(first: Any, second: Any, eps: float = 1e-6) -> bool:
    """Return whether two of a kind differ by less than `eps` in each number."""
    if isinstance(first, Frame):
        return Equal(first.M, second.M, eps) and Equal(first.p, second.p, eps)
    if isinstance(first, Rotation):
        numbers = [(first[row, col], second[row, col]) for row in range(3) for col in range(3)]
    elif isinstance(first, Vector | Twist | Wrench):
        numbers = list(zip(first, second, strict=True))
    else:
        numbers = [(first, second)]
    return all(abs(a - b) < eps for a, b in numbers)
