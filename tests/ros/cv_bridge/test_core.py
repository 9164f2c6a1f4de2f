"""Images there and back, with every type, layout and byte order."""

import struct
import sys
from array import array

import numpy as np
import pytest
from cv_bridge import CvBridge, CvBridgeError, getCvType
from cv_bridge.boost import cv_bridge_boost
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from sensor_msgs.msg import Image
from std_msgs.msg import Header

TYPES = [np.uint8, np.int8, np.uint16, np.int16, np.int32, np.float32, np.float64]
NAMES = ["8U", "8S", "16U", "16S", "32S", "32F", "64F"]


@pytest.fixture
def bridge() -> CvBridge:
    return CvBridge()


# There and back


@pytest.mark.parametrize(("dtype", "name"), list(zip(TYPES, NAMES, strict=True)))
@pytest.mark.parametrize("channels", [None, 1, 2, 3, 4, 5])
def test_every_type(bridge: CvBridge, dtype: type, name: str, channels: int | None) -> None:
    shape = (7, 5) if channels is None else (7, 5, channels)
    image = np.random.default_rng(0).integers(0, 100, shape).astype(dtype)
    message = bridge.cv2_to_imgmsg(image)
    assert message.encoding == f"{name}C{channels or 1}"
    assert (message.height, message.width) == (7, 5)
    assert message.step == 5 * (channels or 1) * image.itemsize
    assert isinstance(message.data, array)
    back = bridge.imgmsg_to_cv2(message)
    assert back.dtype == image.dtype
    np.testing.assert_array_equal(back, image[..., 0] if channels == 1 else image)


@given(hnp.arrays(np.uint16, hnp.array_shapes(min_dims=2, max_dims=3, max_side=6)))
def test_any_image(image: np.ndarray) -> None:
    bridge = CvBridge()
    for big in (False, True):
        given_ = image.astype(image.dtype.newbyteorder(">")) if big else image
        message = bridge.cv2_to_imgmsg(given_)
        assert message.is_bigendian is (big or sys.byteorder == "big")
        back = bridge.imgmsg_to_cv2(message)
        assert back.dtype.isnative
        np.testing.assert_array_equal(back.reshape(image.shape), image)


def test_parts_of_images(bridge: CvBridge) -> None:
    whole = np.arange(240, dtype=np.uint8).reshape(8, 10, 3)
    for part in (whole[2:6, 3:9], whole[:, ::-1], whole[::2], np.asfortranarray(whole), whole[..., 0]):
        np.testing.assert_array_equal(bridge.imgmsg_to_cv2(bridge.cv2_to_imgmsg(part)), part)


def test_rows_with_gaps(bridge: CvBridge) -> None:
    data = b"".join(struct.pack("<3H", row, row + 1, row + 2) + b"??" for row in range(4))
    message = Image(height=4, width=3, encoding="mono16", step=8, data=data)
    np.testing.assert_array_equal(bridge.imgmsg_to_cv2(message), [[row, row + 1, row + 2] for row in range(4)])


def test_other_byte_orders_are_turned_around(bridge: CvBridge) -> None:
    values = [[1, 256, 65535]]
    message = Image(
        height=1, width=3, encoding="16UC1", step=6, is_bigendian=True, data=struct.pack(">3H", 1, 256, 65535)
    )
    for _ in range(2):
        np.testing.assert_array_equal(bridge.imgmsg_to_cv2(message), values)


def test_passing_through_copies_nothing(bridge: CvBridge) -> None:
    message = bridge.cv2_to_imgmsg(np.zeros((2, 3, 3), np.uint8), "bgr8")
    bridge.imgmsg_to_cv2(message)[1, 2, 0] = 7
    assert message.data[15] == 7
    for encoding in ("bgr8", "rgb8"):
        bridge.imgmsg_to_cv2(message, encoding)[0, 0, 0] = 9
        assert 9 not in message.data
    image = np.zeros((2, 3), np.uint8)
    sent = bridge.cv2_to_imgmsg(image)
    image[:] = 5
    assert set(sent.data) == {0}


def test_headers(bridge: CvBridge) -> None:
    header = Header(frame_id="camera")
    assert bridge.cv2_to_imgmsg(np.zeros((1, 1), np.uint8), header=header).header == header
    assert bridge.cv2_to_imgmsg(np.zeros((1, 1), np.uint8)).header == Header()


def test_images_of_nothing(bridge: CvBridge) -> None:
    for shape in ((0, 0), (0, 5), (5, 0), (0, 5, 3)):
        message = bridge.cv2_to_imgmsg(np.zeros(shape, np.uint8))
        assert bridge.imgmsg_to_cv2(message).shape == shape
    assert bridge.imgmsg_to_cv2(Image(encoding="bgr8")).shape == (0, 0, 3)


# What does not fit


@pytest.mark.parametrize("encoding", ["mono8", "mono16", "rgba8", "8UC1", "8SC3", "16UC3", "bayer_rggb8", "uyvy"])
def test_encodings_that_the_image_does_not_fit(bridge: CvBridge, encoding: str) -> None:
    image = np.zeros((2, 3, 3), np.uint8)
    with pytest.raises(CvBridgeError, match=f"encoding specified as {encoding}, but image has incompatible type 8UC3"):
        bridge.cv2_to_imgmsg(image, encoding)


@pytest.mark.parametrize("encoding", ["bgr8", "rgb8", "8UC3"])
def test_encodings_that_it_fits(bridge: CvBridge, encoding: str) -> None:
    assert bridge.cv2_to_imgmsg(np.zeros((2, 3, 3), np.uint8), encoding).encoding == encoding


def test_encodings_that_do_not_exist(bridge: CvBridge) -> None:
    image = np.zeros((2, 3, 3), np.uint8)
    for encoding in ("hello", "", "8UC0", "rgb", "24UC1", "Bgr8"):
        with pytest.raises(CvBridgeError, match="Unrecognized image encoding"):
            bridge.cv2_to_imgmsg(image, encoding)
        with pytest.raises(CvBridgeError):
            bridge.encoding_to_cvtype2(encoding)
    with pytest.raises(CvBridgeError, match=r"Unrecognized image encoding \[hello\]"):
        bridge.imgmsg_to_cv2(bridge.cv2_to_imgmsg(image), "hello")
    with pytest.raises(CvBridgeError):
        bridge.imgmsg_to_cv2(Image(encoding="hello"))


@pytest.mark.parametrize("image", [1, [[1, 2]], None, b"bytes"])
def test_what_is_no_array(bridge: CvBridge, image: object) -> None:
    for convert in (bridge.cv2_to_imgmsg, bridge.cv2_to_compressed_imgmsg):
        with pytest.raises(TypeError, match="Your input type is not a numpy array"):
            convert(image)


@pytest.mark.parametrize("dtype", [np.int64, np.uint32, np.float16, np.bool_, np.complex64])
def test_numbers_that_images_cannot_hold(bridge: CvBridge, dtype: type) -> None:
    with pytest.raises(CvBridgeError, match=f"numbers of type {np.dtype(dtype).name}, only uint8"):
        bridge.cv2_to_imgmsg(np.zeros((2, 2), dtype))


@pytest.mark.parametrize("shape", [(4,), (2, 2, 2, 2)])
def test_arrays_that_are_no_images(bridge: CvBridge, shape: tuple[int, ...]) -> None:
    with pytest.raises(CvBridgeError, match="two or three dimensions"):
        bridge.cv2_to_imgmsg(np.zeros(shape, np.uint8))


def test_too_little_data(bridge: CvBridge) -> None:
    message = Image(height=4, width=3, encoding="bgr8", step=9, data=bytes(35))
    with pytest.raises(CvBridgeError, match="in bgr8 with steps of 9 bytes needs 36 bytes of data, not 35"):
        bridge.imgmsg_to_cv2(message)


# OpenCV's numbers of types


def test_numbers_of_types(bridge: CvBridge, engine: str) -> None:
    if engine == "opencv":
        import cv2

        assert bridge.encoding_to_cvtype2("bgr8") == cv2.CV_8UC3
        for name in NAMES:
            for channels in (1, 2, 3, 4):
                assert getCvType(f"{name}C{channels}") == getattr(cv2, f"CV_{name}C{channels}")
    else:
        assert bridge.encoding_to_cvtype2("bgr8") == 16
        assert getCvType("32FC1") == 5
        assert getCvType("64FC4") == 30
    assert getCvType("8U") == getCvType("8UC1") == getCvType("mono8") == getCvType("bayer_rggb8")
    assert getCvType("rgba8") == getCvType("bgra8") == getCvType("8UC4")
    assert getCvType("uyvy") == getCvType("yuv422") == getCvType("8UC2")
    assert getCvType("rgb16") == getCvType("16UC3")
    assert getCvType("bayer_gbrg16") == getCvType("mono16") == getCvType("16UC1")
    with pytest.raises(RuntimeError, match="Unrecognized"):
        cv_bridge_boost.getCvType("hello")


@pytest.mark.parametrize(("name", "dtype"), list(zip(NAMES, TYPES, strict=True)))
@pytest.mark.parametrize("channels", [1, 3, 4])
def test_types_and_names(bridge: CvBridge, engine: str, name: str, dtype: type, channels: int) -> None:
    generic, numpy_name = f"{name}C{channels}", np.dtype(dtype).name
    number = bridge.encoding_to_cvtype2(generic)
    assert bridge.cvtype_to_name[number] == generic
    assert bridge.cvtype2_to_dtype_with_channels(number) == (numpy_name, channels)
    assert bridge.encoding_to_dtype_with_channels(generic) == (numpy_name, channels)
    assert bridge.dtype_with_channels_to_cvtype2(np.dtype(dtype), channels) == generic
    assert bridge.numpy_type_to_cvtype[numpy_name] == name
    assert bridge.numpy_type_to_cvtype[name] == numpy_name
    assert cv_bridge_boost.CV_MAT_CNWrap(number) == channels
    assert bridge.cvdepth_to_numpy_depth[cv_bridge_boost.CV_MAT_DEPTHWrap(number)] == numpy_name


@given(st.text(max_size=12).filter(lambda name: not name[:1].isdigit()))
def test_any_other_name_is_an_error_that_shows_it(name: str) -> None:
    with pytest.raises(CvBridgeError) as caught:
        CvBridge().encoding_to_dtype_with_channels(name)
    assert f"[{name}]" in str(caught.value)
