"""Assistance devices: the projector's picture, the tower's and the head's Art-Net, and what they refuse."""

from __future__ import annotations

import io
import queue
import socket
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from daidalos.common.errors import UserError
from daidalos.industry.assistance.device import Content, DeviceError
from daidalos.industry.assistance.homography import write_pairs
from daidalos.industry.assistance.light_tower import LightTower, LightTowerParameters
from daidalos.industry.assistance.moving_head import MovingHeadDevice, MovingHeadDeviceParameters
from daidalos.industry.assistance.picture_server import PictureServer
from daidalos.industry.assistance.video_projector import VideoProjector, VideoProjectorParameters
from daidalos.industry.lighting import artnet
from daidalos.industry.lighting.configuration import DEFAULT, read_configuration


@pytest.fixture
def projector(tmp_path: Path) -> Iterator[VideoProjector]:
    """A projector whose picture of 200 x 100 pixels shows x from 0 to 2 m and y from 0 (below) to 1 m."""
    write_pairs(tmp_path / "b.yaml", [(0, 0), (2, 0), (0, 1), (2, 1)], [(0, 100), (200, 100), (0, 0), (200, 0)])
    one = VideoProjector(VideoProjectorParameters(calibration="b.yaml", size=(200, 100), radius=0.2, port=0), tmp_path)
    yield one
    one.close()


def picture(one: VideoProjector) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    """Return what the projector shows."""
    with urllib.request.urlopen(f"{one.url}picture.png", timeout=20) as answer:
        return np.asarray(Image.open(io.BytesIO(answer.read())))


def test_a_ring_lies_around_the_point(projector: VideoProjector) -> None:
    projector.point((1.5, 0.25, 0.0), Content("red"))
    rows, columns = np.nonzero(picture(projector)[:, :, 0])
    assert (rows.mean(), columns.mean()) == pytest.approx((75.0, 150.0), abs=1.0)
    assert np.hypot(rows - 75, columns - 150) == pytest.approx(np.full(len(rows), 20.0), abs=2.5)
    assert not picture(projector)[:, :, 1:].any()
    with pytest.raises(DeviceError, match="out of the picture"):
        projector.point((2.5, 0.5, 0.0), Content())
    with pytest.raises(DeviceError, match="'redd' is no colour"):
        projector.point((1.0, 0.5, 0.0), Content("redd"))
    assert picture(projector).any()  # what is refused leaves the picture
    projector.show(Content("#00ff00"))
    assert (picture(projector) == (0, 255, 0)).all()
    projector.show(Content(text="Press the lever"))
    assert picture(projector).any()
    projector.clear()
    assert not picture(projector).any()


def test_a_browser_gets_each_picture(projector: VideoProjector) -> None:
    found = []
    with urllib.request.urlopen(f"{projector.url}stream", timeout=20) as stream:
        for color in ("black", "blue"):
            if color == "blue":
                projector.show(Content(color))
            for _ in range(2):
                while not (line := stream.readline()).startswith(b"Content-Length"):
                    pass
                stream.readline()
                found.append(Image.open(io.BytesIO(stream.read(int(line.split()[1])))).getpixel((5, 5)))
    assert found == [(0, 0, 0), (0, 0, 0), (0, 0, 255), (0, 0, 255)]


def test_clicks_come_back() -> None:
    clicks = queue.SimpleQueue[tuple[float, float]]()
    server = PictureServer("127.0.0.1", 0, lambda x, y: clicks.put((x, y)))
    for body, is_good in (("[0.25, 0.5]", True), ("[2, 0]", False), ("{", False), ("[1]", False), ("[NaN, 0]", False)):
        request = urllib.request.Request(f"http://127.0.0.1:{server.port}/click", body.encode())
        if is_good:
            assert urllib.request.urlopen(request, timeout=20).status == 200
        else:
            with pytest.raises(urllib.error.HTTPError, match="400"):
                urllib.request.urlopen(request, timeout=20)
    assert clicks.get() == (0.25, 0.5)
    assert clicks.empty()
    with pytest.raises(UserError, match="cannot be served"):
        PictureServer("127.0.0.1", server.port)
    server.close()


@pytest.fixture
def receiver() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        one.settimeout(20.0)
        yield one


def levels(receiver: socket.socket, universe: int) -> bytes:
    """Return the next levels of a universe."""
    while True:
        found = artnet.parse_dmx(receiver.recv(2048))
        if found.universe == universe:
            return found.data


def test_one_lamp_of_the_tower_is_lit(receiver: socket.socket) -> None:
    tower = LightTower(LightTowerParameters(address=3, universe=5, port=receiver.getsockname()[1]), Path())
    tower.show(Content("green"))
    assert levels(receiver, 5)[:6] == bytes([0, 0, 0, 0, 255, 0])
    assert levels(receiver, 5)[:6] == bytes([0, 0, 0, 0, 255, 0])  # sent again without being asked
    with pytest.raises(DeviceError, match="no lamp 'gren'; did you mean 'green'"):
        tower.show(Content("gren"))
    with pytest.raises(DeviceError, match="cannot point"):
        tower.point((0.0, 0.0, 0.0), Content())
    tower.close()
    while any(levels(receiver, 5)):
        pass
    with pytest.raises(DeviceError, match="a universe has 512"):
        LightTower(LightTowerParameters(address=511), Path())


def test_the_head_points_in_a_colour(receiver: socket.socket) -> None:
    port = receiver.getsockname()[1]
    device = MovingHeadDevice(MovingHeadDeviceParameters(artnet_port=port), Path())
    device.point((0.5, -0.3, 0.8), Content("red"))
    head = read_configuration(DEFAULT).make_heads()[0]
    wanted = head.point((0.5, -0.3, 0.8))
    while True:
        data = levels(receiver, 1)[: head.last]
        found = head.angles_of(data)
        if abs(found.pan - wanted.pan) + abs(found.tilt - wanted.tilt) < 1e-3:
            break
    assert data[5] == 255
    assert 10 <= data[7] <= 14  # red on the colour wheel
    for place, content in (((0.0, 0.0, 9.0), Content()), ((0.5, 0.5, 0.8), Content("redd"))):
        with pytest.raises(DeviceError):
            device.point(place, content)
    device.close()
    while levels(receiver, 1)[5]:
        pass
