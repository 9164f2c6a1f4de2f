"""Conversions between encodings, against their formulas and, where it is installed, against OpenCV itself."""

import itertools

import numpy as np
import pytest
from cv_bridge import CvBridge, CvBridgeError, cvtColorForDisplay
from cv_bridge.boost.cv_bridge_boost import cvtColor2
from cv_bridge.encodings import encoding

COLOURS = ["mono8", "rgb8", "bgr8", "rgba8", "bgra8", "mono16", "rgb16", "bgr16", "rgba16", "bgra16"]
RED = {"r": 255, "g": 0, "b": 0, "a": 255}


def picture(name: str, shape: tuple[int, int] = (6, 8)) -> np.ndarray:
    found = encoding(name)
    top = np.iinfo(found.dtype).max
    values = np.random.default_rng(3).integers(0, top + 1, (*shape, found.channels)).astype(found.dtype)
    return values[..., 0] if found.channels == 1 else values


def bits(name: str) -> int:
    return 16 if name.endswith("16") else 8


def planes(image: np.ndarray, name: str) -> dict[str, np.ndarray]:
    """Red, green, blue and alpha from 0 to 1, by definition."""
    values = image / (2.0 ** bits(name) - 1)
    order = name.rstrip("0123456789")
    if order == "mono":
        return {"r": values, "g": values, "b": values, "a": np.ones_like(values)}
    found = {channel: values[..., place] for place, channel in enumerate(order)}
    return {"a": np.ones(values.shape[:2])} | found


@pytest.mark.parametrize(("source", "target"), list(itertools.product(COLOURS, COLOURS)))
def test_colours(engine: str, source: str, target: str) -> None:
    image = picture(source)
    before = image.copy()
    found = cvtColor2(image, source, target)
    assert found.dtype == encoding(target).dtype
    assert found.shape == picture(target).shape
    np.testing.assert_array_equal(image, before)
    is_, wanted = planes(found, target), planes(image, source)
    tolerance = 1.01 / (2 ** min(bits(source), bits(target)) - 1)
    if target.startswith("mono"):
        tolerance += 5e-5  # of the rounded weights
        luma = 0.299 * wanted["r"] + 0.587 * wanted["g"] + 0.114 * wanted["b"]
        np.testing.assert_allclose(is_["r"], luma, atol=tolerance)
        return
    for channel in target.rstrip("0123456789"):
        np.testing.assert_allclose(is_[channel], wanted[channel], atol=tolerance)


def test_red_is_red(engine: str) -> None:
    bridge = CvBridge()
    image = np.zeros((2, 3, 3), np.uint8)
    image[..., 2] = 255
    message = bridge.cv2_to_imgmsg(image, "bgr8")
    for name in ("rgb8", "bgr8", "rgba8", "bgra8"):
        pixel = bridge.imgmsg_to_cv2(message, name)[1, 2]
        assert pixel.tolist() == [RED[channel] for channel in name[:-1]]
    assert bridge.imgmsg_to_cv2(message, "mono8")[1, 2] == 76


def test_16_bits_are_scaled(engine: str) -> None:
    image = np.array([[0, 128, 257, 65535]], np.uint16)
    assert cvtColor2(image, "mono16", "mono8").tolist() == [[0, 0, 1, 255]]
    assert cvtColor2(np.array([[0, 1, 255]], np.uint8), "mono8", "mono16").tolist() == [[0, 257, 65535]]


def test_images_of_one_channel_have_two_dimensions(engine: str) -> None:
    bridge = CvBridge()
    message = bridge.cv2_to_imgmsg(picture("mono8"), "mono8")
    for target in ("mono8", "mono16", "8UC1"):
        assert bridge.imgmsg_to_cv2(message, target).shape == (6, 8)


@pytest.mark.parametrize("name", ["32FC1", "16UC1", "bayer_rggb8", "8UC5", "uyvy"])
def test_the_same_encoding_is_always_possible(engine: str, name: str) -> None:
    bridge = CvBridge()
    found = encoding(name)
    image = np.ones((2, 4) if found.channels == 1 else (2, 4, found.channels), found.dtype)
    message = bridge.cv2_to_imgmsg(image, name)
    np.testing.assert_array_equal(bridge.imgmsg_to_cv2(message, name), image)


@pytest.mark.parametrize(
    ("source", "target", "values"),
    [
        ("32FC1", "16UC1", [0, 2, 2, 65535]),
        ("32FC1", "64FC1", [-1.0, 1.5, 2.5, 1e9]),
        ("32FC1", "16SC1", [-1, 2, 2, 32767]),
    ],
)
def test_plain_numbers_are_rounded_and_limited(engine: str, source: str, target: str, values: list[float]) -> None:
    image = np.array([[-1.0, 1.5, 2.5, 1e9]], np.float32)
    assert cvtColor2(image, source, target).tolist() == [values]


def test_colours_may_become_plain_numbers(engine: str) -> None:
    image = picture("bgr8")
    np.testing.assert_array_equal(cvtColor2(image, "bgr8", "8UC3"), image)
    np.testing.assert_array_equal(cvtColor2(image, "rgb8", "32FC3"), image.astype(np.float32))


@pytest.mark.parametrize(
    ("source", "target", "words"),
    [
        ("8UC3", "mono16", "is not a color format. but"),
        ("8UC3", "bgr8", "is not a color format. but"),
        ("32FC1", "mono8", "does not make sense"),
        ("bgr8", "8UC1", "must have the same OpenCV type"),
        ("8UC3", "8UC1", "do not have the same number of channel"),
        ("bgr8", "bayer_rggb8", r"Unsupported conversion from \[bgr8\] to \[bayer_rggb8\]"),
        ("rgb8", "uyvy", "Unsupported conversion"),
        ("rgb8", "nonsense", "Unrecognized image encoding"),
    ],
)
def test_conversions_that_make_no_sense(engine: str, source: str, target: str, words: str) -> None:
    bridge = CvBridge()
    found = encoding(source)
    image = np.zeros((2, 4) if found.channels == 1 else (2, 4, found.channels), found.dtype)
    with pytest.raises(CvBridgeError, match=words):
        bridge.imgmsg_to_cv2(bridge.cv2_to_imgmsg(image, source), target)
    with pytest.raises(RuntimeError, match=words):
        cvtColor2(image, source, target)


# YUV and Bayer


@pytest.mark.parametrize("name", ["uyvy", "yuyv", "yuv422", "yuv422_yuy2", "UYVY", "YUYV"])
def test_yuv(engine: str, name: str) -> None:
    image = picture("8UC2")
    place = 1 if name.lower() in ("uyvy", "yuv422") else 0
    luma = image[..., place].astype(float)
    u = np.repeat(image[:, ::2, 1 - place], 2, axis=1).astype(float) - 128
    v = np.repeat(image[:, 1::2, 1 - place], 2, axis=1).astype(float) - 128
    level = 1.164 * np.maximum(luma - 16, 0)
    expected = np.stack([level + 1.596 * v, level - 0.391 * u - 0.813 * v, level + 2.018 * u], axis=-1)
    found = cvtColor2(image, name, "rgb8")
    np.testing.assert_allclose(found, np.clip(expected, 0, 255), atol=1.01)
    np.testing.assert_array_equal(cvtColor2(image, name, "bgr8"), found[..., ::-1])
    np.testing.assert_array_equal(cvtColor2(image, name, "mono8"), image[..., place])


@pytest.mark.parametrize("pattern", ["rggb", "bggr", "gbrg", "grbg"])
@pytest.mark.parametrize("depth", [8, 16])
def test_bayer_patterns(pattern: str, depth: int) -> None:
    pytest.importorskip("cv2")
    top = 2**depth - 1
    values = {"r": top, "g": top // 2, "b": 0}
    cell = np.array([values[colour] for colour in pattern]).reshape(2, 2)
    image = np.tile(cell, (8, 8)).astype(np.uint8 if depth == 8 else np.uint16)
    found = cvtColor2(image, f"bayer_{pattern}{depth}", f"rgb{depth}")
    np.testing.assert_array_equal(found[4:12, 4:12], np.broadcast_to([top, top // 2, 0], (8, 8, 3)))
    blue_first = cvtColor2(image, f"bayer_{pattern}{depth}", "bgr8")[8, 8].tolist()
    assert blue_first == [0, pytest.approx(127.5, abs=1), 255]


def test_bayer_patterns_need_opencv(no_opencv: None) -> None:
    bridge = CvBridge()
    message = bridge.cv2_to_imgmsg(picture("bayer_rggb8"), "bayer_rggb8")
    assert bridge.imgmsg_to_cv2(message).shape == (6, 8)
    with pytest.raises(CvBridgeError, match=r"needs OpenCV: pip install 'daidalos\[vision\]'"):
        bridge.imgmsg_to_cv2(message, "bgr8")


# For people to look at


def test_labels_get_colours(engine: str) -> None:
    labels = np.arange(12, dtype=np.int32).repeat(4).reshape(6, 8)
    found = cvtColorForDisplay(labels, "32SC1", "bgr8")
    assert found.shape == (6, 8, 3)
    assert (found.dtype, found.min(), found.max()) == (np.uint8, 0, 255)
    assert len(np.unique(found.reshape(-1, 3), axis=0)) == 12
    with_background = cvtColorForDisplay(labels, "32SC1", "", bg_label=0)
    assert with_background[0, 0].tolist() == [0, 0, 0]
    np.testing.assert_array_equal(with_background[1:], found[1:])
    np.testing.assert_array_equal(cvtColorForDisplay(labels, "32SC1", "rgb8"), found[..., ::-1])


def test_depths_are_scaled(engine: str) -> None:
    depth = np.array([[1.0, 2.0], [3.0, np.nan]], np.float32)
    assert cvtColorForDisplay(depth, "32FC1", "mono8", do_dynamic_scaling=True).tolist() == [[0, 128], [255, 0]]
    limited = cvtColorForDisplay(depth, "32FC1", "", min_image_value=0.0, max_image_value=2.0)
    assert limited.tolist() == [[128, 255], [255, 0]]
    assert cvtColorForDisplay(depth, "32FC1", "bgr8", True).shape == (2, 2, 3)
    flat = np.full((2, 2), 7, np.uint16)
    assert not cvtColorForDisplay(flat, "16UC1", "mono8", do_dynamic_scaling=True).any()


def test_colours_stay_colours(engine: str) -> None:
    image = picture("rgb8")
    np.testing.assert_array_equal(cvtColorForDisplay(image, "rgb8", ""), image[..., ::-1])
    np.testing.assert_array_equal(cvtColorForDisplay(image, "8UC3", "rgb8"), image[..., ::-1])
    assert cvtColorForDisplay(picture("mono16"), "mono16", "").dtype == np.uint8


def test_what_cannot_be_shown(engine: str) -> None:
    with pytest.raises(RuntimeError, match="output encoding"):
        cvtColorForDisplay(picture("rgb8"), "rgb8", "mono16")
    with pytest.raises(RuntimeError, match="ask for scaling"):
        cvtColorForDisplay(np.zeros((2, 2), np.float32), "32FC1", "mono8")


def test_maps_of_colours() -> None:
    pytest.importorskip("cv2")
    depth = np.linspace(0, 1, 16, dtype=np.float32).reshape(4, 4)
    found = cvtColorForDisplay(depth, "32FC1", "bgr8", do_dynamic_scaling=True, colormap=2)
    assert found.shape == (4, 4, 3)
    assert len(np.unique(found.reshape(-1, 3), axis=0)) > 8


def test_maps_of_colours_need_opencv(no_opencv: None) -> None:
    with pytest.raises(RuntimeError, match="needs OpenCV"):
        cvtColorForDisplay(np.zeros((2, 2), np.float32), "32FC1", "bgr8", do_dynamic_scaling=True, colormap=2)


# OpenCV and numpy agree


@pytest.mark.parametrize("source", [*COLOURS, "uyvy", "yuyv"])
@pytest.mark.parametrize("target", COLOURS)
def test_both_engines_give_the_same(source: str, target: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("cv2")
    image = picture(source, (33, 46))
    by_opencv = cvtColor2(image, source, target)
    monkeypatch.setattr("cv_bridge.conversions.opencv", lambda: None)
    np.testing.assert_array_equal(cvtColor2(image, source, target), by_opencv)
