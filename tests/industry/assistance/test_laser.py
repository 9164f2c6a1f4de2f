"""The laser projector: where its beam goes, what it draws, and what it sends."""

from __future__ import annotations

import math
import socket
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.description.geometry import Box, Capsule, Cylinder, Sphere
from daidalos.industry.assistance.device import Content, DeviceError
from daidalos.industry.assistance.galvanometer import Galvanometer
from daidalos.industry.assistance.laser_figure import STEP, ring, subdivide, trace
from daidalos.industry.assistance.laser_projector import LaserProjector, LaserProjectorParameters
from daidalos.industry.assistance.surfaces import hits
from daidalos.industry.lighting import idn

DOWN = Pose.from_xyz_rpy((0.2, -0.1, 2.5), (math.pi, 0.0, 0.0))


def test_the_beam_meets_the_point_it_was_sent_to() -> None:
    random = np.random.default_rng(1)
    pose = Pose.from_xyz_rpy((0.3, -0.4, 2.2), (2.9, 0.2, 0.7))
    scanner = Galvanometer(pose, (0.5, 0.4), 0.05)
    points = np.column_stack([random.uniform(-0.5, 0.5, (50, 2)), random.uniform(0.0, 1.0, 50)])
    origins, directions = scanner.rays(scanner.deflections(points))
    assert np.linalg.norm(directions, axis=1) == pytest.approx(np.ones(50))
    apart = points - origins
    off = apart - np.sum(apart * directions, axis=1)[:, None] * directions
    assert np.abs(off).max() < 1e-12


def test_deflections_are_those_of_two_mirrors() -> None:
    """Two mirrors, one behind the other: reflected step by step."""
    e, ax, ay = 0.04, 0.3, -0.2
    scanner = Galvanometer(Pose(), (1.0, 1.0), e)
    # The first mirror sends the beam from (0, 0, -e) into the x-z plane, the second turns that plane about x.
    start, way = np.array([0.0, 0.0, -e]), np.array([math.sin(ax), 0.0, math.cos(ax)])
    turn = np.array([[1, 0, 0], [0, math.cos(ay), math.sin(ay)], [0, -math.sin(ay), math.cos(ay)]])
    for length in (0.5, 2.0):
        point = turn @ (start + length * way)
        assert scanner.deflections(point)[0] == pytest.approx((ax, ay))
    assert np.isnan(scanner.deflections((0.0, 0.0, -1.0))).all()


def test_samples_follow_the_lines_and_are_dark_between_them() -> None:
    square = np.array([[0.0, 0.0], [0.3, 0.0], [0.3, 0.3]])
    frame = trace([square, square - 0.5], (10, 20, 30), 1000.0)
    assert np.linalg.norm(np.diff(frame.places, axis=0), axis=1).max() <= STEP + 1e-12
    lit = frame.colors.any(axis=1)
    ends = np.flatnonzero(np.diff(lit.astype(int)) == 1) + 1
    assert frame.places[ends] == pytest.approx(np.array([square[0], square[0] - 0.5]))
    assert (frame.colors[lit] == (10, 20, 30)).all()
    assert not lit[0]  # the first sample is where the beam waits
    assert frame.places[0] == pytest.approx(square[-1] - 0.5)
    assert (np.linalg.norm(frame.places - square[1], axis=1) < 1e-9).sum() == 2  # the mirrors rest at the corner
    assert frame.duration == pytest.approx(len(lit) / 1000.0)
    assert len(trace([], (1, 1, 1), 1000.0).places) == 0
    assert subdivide(square, 0.1)[[0, 3, 6]] == pytest.approx(square)


def test_rays_meet_the_nearest_surface() -> None:
    down = np.tile([0.0, 0.0, -1.0], (7, 1))
    above = np.array([[0, 0, 2], [0.45, 0, 2], [2, 0, 2], [2.2, 0, 2], [4, 0.3, 2], [6, 0, 2], [0, 0, 0.2]], float)
    shapes = [
        (Pose((0.0, 0.0, 0.5)), Box((1.0, 1.0, 0.4))),
        (Pose((2.0, 0.0, 0.5)), Cylinder(0.3, 1.0)),
        (Pose((4.0, 0.0, 0.5)), Sphere(0.5)),
        (Pose((6.0, 0.0, 0.5)), Capsule(0.5, 1.0)),  # passed through
    ]
    found = hits(above, down, shapes, 0.0)
    assert found[:, 2] == pytest.approx([0.7, 0.7, 1.0, 1.0, 0.9, 0.0, 0.0])
    assert found[:, :2] == pytest.approx(above[:, :2])
    turned = [(Pose.from_xyz_rpy((0.0, 0.0, 0.5), (0.0, 0.0, math.pi / 4)), Box((1.0, 1.0, 0.4)))]
    assert np.isnan(hits(np.array([[0.6, 0.6, 2.0]]), down[:1], turned, None)).all()
    assert hits(np.array([[0.0, 0.69, 2.0]]), down[:1], turned, None)[0, 2] == pytest.approx(0.7)
    side = hits(np.array([[-3.0, 0.0, 0.5]]), np.array([[1.0, 0.0, 0.0]]), shapes[1:], None)
    assert side[0] == pytest.approx((1.7, 0.0, 0.5))
    assert np.isnan(hits(above[:1], -down[:1], shapes, 0.0)).all()  # the floor and the box are behind


@pytest.fixture
def receiver() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        one.settimeout(20.0)
        yield one


def frames(receiver: socket.socket) -> Iterator[idn.Frame | None]:
    """Yield what is received: frames, and None when the connection is closed."""
    while True:
        yield idn.parse_packet(receiver.recv(0x10000))


@pytest.mark.slow
def test_the_ring_lies_around_the_place(receiver: socket.socket) -> None:
    parameters = LaserProjectorParameters(port=receiver.getsockname()[1], radius=0.05, brightness=0.5)
    laser = LaserProjector(parameters, Path())
    laser.point((0.3, -0.2, 0.75), Content("#ff8000"))
    received = frames(receiver)
    for _ in range(2):  # at once, and again without being asked
        frame = next(one for one in received if one is None or len(one.places))
        assert frame is not None
        origins, directions = parameters.galvanometer().rays(frame.places)
        table = hits(origins, directions, [], 0.75)[frame.colors.any(axis=1)]
        assert np.hypot(table[:, 0] - 0.3, table[:, 1] + 0.2) == pytest.approx(np.full(len(table), 0.05), abs=5e-4)
        assert {tuple(one) for one in frame.colors.tolist()} == {(0, 0, 0), (128, 64, 0)}
    refused = [
        ((3.0, 0.0, 0.75), Content(), "out of the field of 60 x 60 degrees"),
        ((0.0, 0.0, 3.0), Content(), "out of the field"),
        ((0.0, 0.0, 0.7), Content("redd"), "'redd' is no colour"),
        ((0.0, 0.0, 0.7), Content(text="ü"), "has no 'Ü'"),
        ((-0.9, 0.0, 0.7), Content(text="8" * 40), "out of the field|shorten the text"),
    ]
    for place, content, problem in refused:
        with pytest.raises(DeviceError, match=problem):
            laser.point(place, content)
    with pytest.raises(DeviceError, match="shorten the text"):
        laser.show(Content(text="8" * 200))
    shown = next(received)
    assert shown is not None
    assert len(shown.places) == len(frame.places)  # what is refused leaves the picture
    laser.show(Content("green", "M6 X 20"))
    laser.show(Content("blue"))
    circle = next(one for one in received if one is not None and one.colors[:, 2].any())
    assert circle is not None
    assert np.hypot(*circle.places[circle.colors.any(axis=1)].T) == pytest.approx(0.5, abs=2e-3)
    laser.close()
    last = list(iter(lambda: next(received), None))  # up to the packet that closes
    assert len(last[-1].places) == 0
    receiver.setblocking(False)
    with pytest.raises(BlockingIOError):
        receiver.recv(0x10000)


def test_a_text_stands_beside_the_ring(receiver: socket.socket) -> None:
    parameters = LaserProjectorParameters(port=receiver.getsockname()[1], text_direction_deg=90.0, text_height=0.1)
    laser = LaserProjector(parameters, Path())
    laser.point((0.0, 0.0, 0.5), Content(text="L"))
    frame = next(one for one in frames(receiver) if one is None or len(one.places))
    assert frame is not None
    table = hits(*parameters.galvanometer().rays(frame.places), [], 0.5)[frame.colors.any(axis=1)]
    letter = table[np.hypot(table[:, 0], table[:, 1]) > 0.05]
    # Written along y, an L of 0.1 x 0.067 m: its left edge is 0.09 m from the middle, its base line at x = 0.05 m.
    assert letter[:, :2].min(axis=0) == pytest.approx((-0.05, 0.09), abs=1e-3)
    assert letter[:, :2].max(axis=0) == pytest.approx((0.05, 0.09 + 0.1 * 4 / 6), abs=1e-3)
    laser.close()


def test_rings_are_closed() -> None:
    found = ring((1.0, 2.0, 3.0), 0.5)
    assert found[0] == pytest.approx(found[-1])
    assert (found[:, 2] == 3.0).all()
