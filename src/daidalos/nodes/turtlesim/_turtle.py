"""Motion of a turtle: an ideal wheeled robot on a square with walls."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

UPDATE_S = 0.016
COMMAND_LASTS_S = 1.0
SIZE = float(np.float32(499 / 45))  # a window of 500 pixels, 45 pixels to the unit
TURNING_SPEED = 1.0  # of a rotation that is an action's goal, in rad/s
TURNED = 0.01  # how far from its goal a rotation has ended, in rad


@dataclass(frozen=True)
class Pen:
    """Pen of a turtle: colour, width in pixels (0 draws the finest line), and whether it is down."""

    r: int = 0xB3
    g: int = 0xB8
    b: int = 0xFF
    width: int = 3
    is_down: bool = True


@dataclass
class Turtle:
    """State of a turtle.

    Headings and speeds have single precision, as in the messages, so that rounding adds up as it does there.

    Attributes
    ----------
    name
        Its name.
    x, y
        Position in units, the origin at the lower left.
    theta
        Heading in rad, counterclockwise from x, between -pi and pi.
    kind
        Which drawing shows it.
    forward, sideways, angular
        Speeds in units/s and rad/s.
    pen
        What it draws with.
    """

    name: str
    x: float
    y: float
    theta: float
    kind: int = 0
    forward: float = 0.0
    sideways: float = 0.0
    angular: float = 0.0
    pen: Pen = field(default_factory=Pen)
    _commanded_s: float = -math.inf

    def command(self, forward: float, sideways: float, angular: float, now_s: float) -> None:
        """Set the velocity until the next command, for at most a second."""
        self.forward, self.sideways, self.angular = _single(forward), _single(sideways), _single(angular)
        self._commanded_s = now_s

    def step(self, now_s: float) -> tuple[float, float] | None:
        """Move for one update.

        Returns
        -------
        tuple of float, optional
            Where it would have gone, if a wall held it.
        """
        if now_s - self._commanded_s > COMMAND_LASTS_S:
            self.stop()
        self.theta = normalized(_single(self.theta + self.angular * UPDATE_S))
        cosine, sine = math.cos(self.theta), math.sin(self.theta)
        wanted = (
            self.x + (cosine * self.forward - sine * self.sideways) * UPDATE_S,
            self.y + (sine * self.forward + cosine * self.sideways) * UPDATE_S,
        )
        self.x, self.y = (min(max(value, 0.0), SIZE) for value in wanted)
        return wanted if (self.x, self.y) != wanted else None

    @property
    def is_still(self) -> bool:
        """Whether it has no speed."""
        return not (self.forward or self.sideways or self.angular)

    def stop(self) -> None:
        """Stop."""
        self.forward = self.sideways = self.angular = 0.0

    def turn_towards(self, theta: float, now_s: float) -> float:
        """Turn on the spot towards a heading, or stop where it is reached; returns the angle that is left."""
        left = self.angle_to(theta)
        if abs(left) < TURNED:
            self.stop()
        else:
            self.command(0.0, 0.0, math.copysign(TURNING_SPEED, left), now_s)
        return left

    def angle_to(self, theta: float) -> float:
        """Return the angle from its heading to another, the short way round."""
        return normalized(_single(normalized(theta) - self.theta))

    def teleport(self, x: float, y: float, theta: float) -> None:
        """Set the position at once; the next step moves it back within the walls."""
        self.x, self.y, self.theta = x, y, normalized(theta)

    def teleport_relative(self, linear: float, angular: float) -> None:
        """Turn by an angle, then be somewhere ahead, at once."""
        theta = normalized(_single(self.theta + angular))
        self.teleport(self.x + linear * math.cos(theta), self.y + linear * math.sin(theta), theta)


def normalized(angle: float) -> float:
    """Return the same heading between -pi and pi."""
    return _single(math.remainder(angle, math.tau))


def _single(value: float) -> float:
    return float(np.float32(value))
