"""Walking along a line."""

from __future__ import annotations

import math


class LineIterator:
    """Iterator from one point to another, in steps along x; along y where the line is upright.

    Parameters
    ----------
    x0, y0, x1, y1
        Where the line begins and ends.
    step_size
        How far a step goes.

    Raises
    ------
    TypeError
        If one of them is not a number.
    ValueError
        If the two points are one, or the step does not go forward.
    """

    def __init__(self, x0: float, y0: float, x1: float, y1: float, step_size: float = 1.0) -> None:
        for name, value in (("x0", x0), ("y0", y0), ("x1", x1), ("y1", y1), ("step_size", step_size)):
            if isinstance(value, bool) or not isinstance(value, int | float):
                raise TypeError(f"{name} must be a number, not {type(value).__name__}")
        if step_size <= 0:
            raise ValueError(f"step_size must be above 0, not {step_size}")
        if (x0, y0) == (x1, y1):
            raise ValueError("the line has no length: it ends where it begins")
        self.x0_, self.y0_, self.x1_, self.y1_ = x0, y0, x1, y1
        self.x_, self.y_, self.step_size_, self.valid_ = x0, y0, step_size, True
        self._steps = 0

    def isValid(self) -> bool:
        """Return whether the end has not been passed."""
        return self.valid_

    def advance(self) -> None:
        """Advance one step, at most to the end; at the end the iteration is over."""
        if (self.x_, self.y_) == (self.x1_, self.y1_):
            self.valid_ = False
            return
        self._steps += 1
        dx, dy = self.x1_ - self.x0_, self.y1_ - self.y0_
        # Counted rather than summed up, so that the last step is not missed by a rounding.
        share = self._steps * self.step_size_ / abs(dx or dy)
        if share >= 1 - 1e-9:
            self.x_, self.y_ = self.x1_, self.y1_
        elif dx:
            self.x_, self.y_ = self.x0_ + share * dx, round(self.y0_ + share * dy, 5)
        else:
            self.y_ = self.y0_ + share * dy

    def getX(self) -> float:
        """Return x of where the walk is."""
        return self.x_

    def getY(self) -> float:
        """Return y of where the walk is."""
        return self.y_

    def getX0(self) -> float:
        """Return x of the beginning."""
        return self.x0_

    def getY0(self) -> float:
        """Return y of the beginning."""
        return self.y0_

    def getX1(self) -> float:
        """Return x of the end."""
        return self.x1_

    def getY1(self) -> float:
        """Return y of the end."""
        return self.y1_

    def get_line_length(self) -> float:
        """Return how long the line is."""
        return math.hypot(self.x1_ - self.x0_, self.y1_ - self.y0_)

    def clamp(self, n: float, min_n: float, max_n: float) -> float:
        """Return a number, or the limit that it is beyond."""
        return max(min_n, min(n, max_n))
