"""Compressed images, by OpenCV or Pillow, or by neither."""

import builtins

import numpy as np
import pytest
from cv_bridge import CvBridge, CvBridgeError
from sensor_msgs.msg import CompressedImage

SMOOTH = np.add.outer(np.arange(32), np.arange(48)).astype(np.uint8) * 2
RED = np.zeros((16, 24, 3), np.uint8)
RED[..., 2] = 255


@pytest.fixture
def codec(engine: str) -> str:
    if engine == "numpy":
        pytest.importorskip("PIL")
    return engine


@pytest.mark.parametrize("name", ["png", "bmp", "tiff", "tif", "ppm"])
def test_formats_without_loss(codec: str, name: str) -> None:
    bridge = CvBridge()
    image = np.random.default_rng(0).integers(0, 256, (17, 23, 3)).astype(np.uint8)
    message = bridge.cv2_to_compressed_imgmsg(image, name)
    assert message.format == name
    np.testing.assert_array_equal(bridge.compressed_imgmsg_to_cv2(message), image)


@pytest.mark.parametrize("name", ["jpg", "jpeg", "jpe", "webp"])
def test_formats_with_loss(codec: str, name: str) -> None:
    bridge = CvBridge()
    image = np.stack([SMOOTH, SMOOTH // 2, 255 - SMOOTH], axis=-1)
    found = bridge.compressed_imgmsg_to_cv2(bridge.cv2_to_compressed_imgmsg(image, name))
    assert found.shape == image.shape
    assert np.abs(found.astype(int) - image).mean() < 8


def test_jpg_by_default(codec: str) -> None:
    message = CvBridge().cv2_to_compressed_imgmsg(RED)
    assert message.format == "jpg"
    assert bytes(message.data[:3]) == b"\xff\xd8\xff"


@pytest.mark.parametrize(
    "image",
    [SMOOTH, SMOOTH[..., np.newaxis], SMOOTH.astype(np.uint16) * 257, np.dstack([RED, np.full((16, 24), 9, np.uint8)])],
    ids=["grey", "one channel", "16 bits", "alpha"],
)
def test_other_images(codec: str, image: np.ndarray) -> None:
    bridge = CvBridge()
    found = bridge.compressed_imgmsg_to_cv2(bridge.cv2_to_compressed_imgmsg(image, "png"))
    assert found.dtype == image.dtype
    np.testing.assert_array_equal(found, image[..., 0] if image.shape[2:] == (1,) else image)


def test_desired_encodings(codec: str) -> None:
    bridge = CvBridge()
    red = bridge.cv2_to_compressed_imgmsg(RED, "png")
    assert bridge.compressed_imgmsg_to_cv2(red)[0, 0].tolist() == [0, 0, 255]
    assert bridge.compressed_imgmsg_to_cv2(red, "rgb8")[0, 0].tolist() == [255, 0, 0]
    assert bridge.compressed_imgmsg_to_cv2(red, "rgba8")[0, 0].tolist() == [255, 0, 0, 255]
    grey = bridge.cv2_to_compressed_imgmsg(SMOOTH, "png")
    assert bridge.compressed_imgmsg_to_cv2(grey, "bgr8").shape == (32, 48, 3)
    with pytest.raises(CvBridgeError, match="Unrecognized"):
        bridge.compressed_imgmsg_to_cv2(red, "nonsense")


def test_formats_that_do_not_exist(codec: str) -> None:
    with pytest.raises(CvBridgeError, match="cannot write an image of shape"):
        CvBridge().cv2_to_compressed_imgmsg(RED, "nonsense")


def test_types_that_a_format_cannot_hold(codec: str) -> None:
    with pytest.raises(CvBridgeError):
        CvBridge().cv2_to_compressed_imgmsg(np.zeros((4, 4, 2), np.int32), "png")


@pytest.mark.parametrize("data", [b"", b"no image at all", b"\x89PNG\r\n\x1a\n" + bytes(20)])
def test_data_that_is_no_image(codec: str, data: bytes) -> None:
    with pytest.raises(CvBridgeError, match=f"the {len(data)} bytes of data are not a compressed image"):
        CvBridge().compressed_imgmsg_to_cv2(CompressedImage(format="png", data=data))


def test_the_command_that_adds_what_is_missing(no_opencv: None, monkeypatch: pytest.MonkeyPatch) -> None:
    importing = builtins.__import__

    def without_pillow(name: str, *arguments: object, **options: object) -> object:
        if name.startswith("PIL"):
            raise ImportError(name)
        return importing(name, *arguments, **options)

    monkeypatch.setattr(builtins, "__import__", without_pillow)
    bridge = CvBridge()
    with pytest.raises(CvBridgeError, match=r"needs OpenCV or Pillow: pip install 'daidalos\[vision\]'"):
        bridge.cv2_to_compressed_imgmsg(RED)
    with pytest.raises(CvBridgeError, match=r"needs OpenCV or Pillow: pip install 'daidalos\[vision\]'"):
        bridge.compressed_imgmsg_to_cv2(CompressedImage(format="jpg", data=b"123"))
