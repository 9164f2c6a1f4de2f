"""`daidalos assist calibrate --camera`: from the images of a topic to the file of pairs."""

from __future__ import annotations

import argparse
import io
import threading
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from cv_bridge import CvBridge
from rclpy.node import Node
from sensor_msgs.msg import Image

from daidalos.cli.daidalos.assist_calibration import calibrate
from daidalos.common.errors import UserError
from daidalos.industry.assistance.homography import read_homography
from industry.assistance.test_projector_calibration import CORNERS, KNOWN, PROJECTOR, TO_PROJECTOR, Table
from mqtt_brokers import free_port


@pytest.fixture
def camera(node: Node) -> Iterator[Callable[[int, str], None]]:
    """A function that begins to publish what a camera sees of a projector's page, until the test ends."""
    publisher, ending, threads = node.create_publisher(Image, "/eye", 10), threading.Event(), list[threading.Thread]()

    def watch(port: int, encoding: str) -> None:
        table = Table()
        while not ending.wait(0.02):
            try:
                with urllib.request.urlopen(f"http://127.0.0.1:{port}/picture.png", timeout=5) as answer:
                    table.show(answer.read())
            except OSError:  # the page is not served yet, or not any more
                continue
            seen = np.clip(table.take(), 0.0, 255.0).astype(np.uint8)
            picture = seen if encoding == "mono8" else np.repeat(seen[:, :, None], 3, axis=2)
            publisher.publish(CvBridge().cv2_to_imgmsg(picture, encoding))

    def begin(port: int, encoding: str) -> None:
        threads.append(threading.Thread(target=watch, args=(port, encoding)))
        threads[-1].start()

    yield begin
    ending.set()
    for one in threads:
        one.join()


def arguments(output: Path, **changes: object) -> argparse.Namespace:
    values = {"points": KNOWN, "size": PROJECTOR, "port": free_port(), "camera": "/eye", "settle": 0.1}
    return argparse.Namespace(output=output, **{**values, **changes})


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ["mono8", "bgr8"])
def test_a_projector_is_calibrated(
    camera: Callable[[int, str], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, encoding: str
) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO("\n"))
    one = arguments(tmp_path / "beamer.yaml")
    camera(one.port, encoding)
    assert calibrate(one) == 0
    assert np.abs(read_homography(one.output).pixels(CORNERS) - TO_PROJECTOR).max() < 2.0


def test_what_cannot_be_is_named(tmp_path: Path) -> None:
    there = tmp_path / "there.yaml"
    there.write_text("")
    for changes, problem in (
        ({"points": KNOWN[:4]}, "5 or more points are needed"),
        ({"points": None}, "5 or more points"),
        ({"size": (3, 3)}, "--size"),
        ({"settle": float("nan")}, "--settle"),
    ):
        with pytest.raises(UserError, match=problem):
            calibrate(arguments(tmp_path / "new.yaml", **changes))
    with pytest.raises(UserError, match="exists"):
        calibrate(arguments(there))
    assert list(tmp_path.iterdir()) == [there]
