"""One moving head: it aims at points, shows a look, and writes both into its DMX channels."""

from __future__ import annotations

import math
from dataclasses import replace

from daidalos.common.pose3 import Vector
from daidalos.industry.lighting.fixture import PAN, TILT, Channel, Fixture, FixtureError, ValueRange
from daidalos.industry.lighting.kinematics import Angles, Geometry, Limits, PointingError, aim
from daidalos.industry.lighting.look import Look, read_angles, write_angles, write_look
from daidalos.industry.lighting.motion import Motion


class Head:
    """Moving head on a DMX universe.

    It begins dark and in its middle position, and lights up at the first point.

    Parameters
    ----------
    name : str
        Also the first part of its MQTT topics.
    fixture : Fixture
    geometry : Geometry
        Where it is and its calibrated angles.
    universe, address : int
        Its DMX universe and its first channel, from 1.
    look : Look
        What it shows when it points.
    is_pan_inverted, is_tilt_inverted : bool
        Whether greater DMX values turn the other way round.
    is_smooth : bool
        Whether movements are sent as a profile of limited speed and acceleration; else only their ends.

    Raises
    ------
    FixtureError
        When the channels do not fit into the universe, or the fixture has no pan or tilt.
    """

    def __init__(
        self,
        name: str,
        fixture: Fixture,
        geometry: Geometry,
        universe: int = 1,
        address: int = 1,
        look: Look = Look(),  # noqa: B008 - frozen
        is_pan_inverted: bool = False,
        is_tilt_inverted: bool = False,
        is_smooth: bool = True,
    ) -> None:
        self.name, self.fixture, self.geometry, self.universe = name, fixture, geometry, universe
        self.look = look
        self.first, self.last = address, address + fixture.size - 1
        if address < 1 or self.last > 512:
            raise FixtureError(f"head '{name}': channels {address} to {self.last} are not within 1 to 512")
        self._signs = (-1.0 if is_pan_inverted else 1.0, -1.0 if is_tilt_inverted else 1.0)
        self.limits = self._fixture_limits()
        self._is_smooth = is_smooth
        self._is_lit = False
        self._data = bytearray(512)
        self.motion = Motion(Angles(0.0, 0.0), self.limits)
        self._reset()

    def attach(self, data: bytearray) -> None:
        """Write into the levels of a universe from now on."""
        data[self.first - 1 : self.last] = self._data[self.first - 1 : self.last]
        self._data = data

    @property
    def angles(self) -> Angles:
        """Where the head is, as far as is known without feedback."""
        return self.motion.angles

    @property
    def is_moving(self) -> bool:
        """Whether the head is on its way."""
        return self.motion.is_moving

    @property
    def is_lit(self) -> bool:
        """Whether it has lit up, since its start or the last blackout."""
        return self._is_lit

    @property
    def levels(self) -> bytes:
        """Values of its channels."""
        return bytes(self._data[self.first - 1 : self.last])

    def angles_of(self, levels: bytes) -> Angles:
        """Return the pan and tilt that values of its channels mean."""
        found = read_angles(self.fixture, levels)
        return Angles(self._signs[0] * found.pan, self._signs[1] * found.tilt)

    def point(self, point: Vector) -> Angles:
        """Aim at a point of the world [m] and return the angles.

        Raises
        ------
        PointingError
            When it is out of range; the head then stays as it is.
        """
        angles = aim(self.geometry, self.limits, point, self.motion.target)
        self.turn(angles)
        return angles

    def turn(self, angles: Angles) -> None:
        """Turn to pan and tilt [rad], and light up.

        Raises
        ------
        PointingError
            When an angle is out of its range.
        """
        if not self.limits.allow(angles):
            raise PointingError(
                f"pan {math.degrees(angles.pan):.1f} and tilt {math.degrees(angles.tilt):.1f} degrees are out of range"
            )
        self.motion.target = angles
        if not self._is_smooth:
            self._write_angles(angles)
        if not self._is_lit:
            self.show(self.look)

    def show(self, look: Look) -> None:
        """Show a look from now on.

        Raises
        ------
        FixtureError
            When the fixture cannot; its channels then stay as they are.
        """
        data = bytearray(self.levels)
        write_look(self.fixture, look, data)
        self._data[self.first - 1 : self.last] = data
        self.look = look
        self._is_lit = True

    def set_channels(self, values: dict[int, int]) -> None:
        """Set channels of the fixture, from 1, to values from 0 to 255.

        Raises
        ------
        FixtureError
            When there is no such channel or value; no channel is then set.
        """
        for channel, value in values.items():
            if not 1 <= channel <= self.fixture.size:
                raise FixtureError(f"there is no channel {channel}: {self.fixture.name} has 1 to {self.fixture.size}")
            if not 0 <= value <= 255:
                raise FixtureError(f"the value of channel {channel} must be from 0 to 255, got {value}")
        self._is_lit = True
        for channel, value in values.items():
            self._data[self.first + channel - 2] = value
        moving = {offset + 1 for function in (PAN, TILT) for offset in self._axis(function)[0].offsets}
        if moving & values.keys():
            self.motion.jump(self._read_angles())

    def blackout(self) -> None:
        """Switch the light off; the next point lights it up again."""
        data = bytearray(self.levels)
        write_look(self.fixture, replace(self.look, dimmer=0.0, strobe=0.0), data)
        self._data[self.first - 1 : self.last] = data
        self._is_lit = False

    def hold(self) -> None:
        """Stop where the head is."""
        self.motion.jump(self.motion.angles)
        self._write_angles(self.motion.angles)

    def step(self, dt: float) -> bool:
        """Move on for a time [s]; return whether channels have changed."""
        if not self.motion.is_moving:
            return False
        angles = self.motion.step(dt)
        if not self._is_smooth:
            return False
        self._write_angles(angles)
        return True

    def _reset(self) -> None:
        self._data[self.first - 1 : self.last] = self.fixture.defaults
        self.blackout()
        self.motion.jump(self._read_angles())

    def _fixture_limits(self) -> Limits:
        ranges = []
        for function, sign in zip((PAN, TILT), self._signs, strict=True):
            _, meaning = self._axis(function)
            least, most = sorted((sign * meaning.start, sign * meaning.end))
            ranges.append((least, most))
        fixture = self.fixture
        return Limits(ranges[0], ranges[1], fixture.pan_speed, fixture.tilt_speed, fixture.acceleration)

    def _axis(self, function: str) -> tuple[Channel, ValueRange]:
        axis = self.fixture.axis(function)
        if axis is None:
            raise FixtureError(f"{self.fixture.name} has no {function} in its mode '{self.fixture.mode}'")
        return axis

    def _write_angles(self, angles: Angles) -> None:
        turned = Angles(self._signs[0] * angles.pan, self._signs[1] * angles.tilt)
        write_angles(self.fixture, turned, self._data, self.first - 1)

    def _read_angles(self) -> Angles:
        return self.angles_of(self.levels)
