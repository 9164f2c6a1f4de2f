"""The bridge."""

from __future__ import annotations

import sys
from array import array
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

from .compression import compress, decompress
from .conversions import cvtColor2
from .encodings import (
    DEPTHS,
    CV_MAT_CNWrap,
    CV_MAT_DEPTHWrap,
    encoding,
    getCvType,
    type_name,
    type_number,
)


class CvBridgeError(TypeError):
    """An image cannot be converted."""


class CvBridge:
    """Converter between messages and numpy arrays, the images of OpenCV.

    OpenCV itself is needed only for Bayer patterns; compressed images need OpenCV or Pillow.
    """

    def __init__(self) -> None:
        names = {name: dtype.name for name, dtype in DEPTHS.items()}
        self.numpy_type_to_cvtype = {dtype: name for name, dtype in names.items()} | names

    @cached_property
    def cvtype_to_name(self) -> dict[int, str]:
        """The generic names of OpenCV's types by their numbers."""
        return {type_number(depth, count): f"{depth}C{count}" for depth in DEPTHS for count in range(1, 5)}

    @cached_property
    def cvdepth_to_numpy_depth(self) -> dict[int, str]:
        """Numpy's names of OpenCV's depths by their numbers."""
        return {number: dtype.name for number, dtype in enumerate(DEPTHS.values())}

    def dtype_with_channels_to_cvtype2(self, dtype: np.dtype[Any], n_channels: int) -> str:
        """Return the generic name of an array's type, such as ``8UC3``.

        Raises
        ------
        CvBridgeError
            When images cannot hold numbers of that type.
        """
        try:
            return type_name(dtype, n_channels)
        except KeyError:
            kinds = ", ".join(one.name for one in DEPTHS.values())
            raise CvBridgeError(f"an image cannot hold numbers of type {dtype.name}, only {kinds}") from None

    def cvtype2_to_dtype_with_channels(self, cvtype: int) -> tuple[str, int]:
        """Return numpy's name, and the number of channels, of one of OpenCV's types."""
        return self.cvdepth_to_numpy_depth[CV_MAT_DEPTHWrap(cvtype)], CV_MAT_CNWrap(cvtype)

    def encoding_to_cvtype2(self, encoding: str) -> int:
        """Return the number of OpenCV's type of an encoding.

        Raises
        ------
        CvBridgeError
            When there is no encoding of that name.
        """
        try:
            return getCvType(encoding)
        except RuntimeError as error:
            raise CvBridgeError(error) from None

    def encoding_to_dtype_with_channels(self, encoding: str) -> tuple[str, int]:
        """Return numpy's name of the numbers, and the number of channels, of an encoding.

        Raises
        ------
        CvBridgeError
            When there is no encoding of that name.
        """
        found = _encoding(encoding)
        return found.dtype.name, found.channels

    def imgmsg_to_cv2(self, img_msg: Image, desired_encoding: str = "passthrough") -> NDArray[Any]:
        """Return the image in a message.

        Parameters
        ----------
        img_msg
            The message.
        desired_encoding
            The encoding of the result. With "passthrough" it stays as it is, and where it can, the array shows the
            data of the message.

        Returns
        -------
        array of shape (height, width), or (height, width, channels) when there is more than one channel

        Raises
        ------
        CvBridgeError
            When there is no such encoding or conversion, or the data is too short.
        """
        image = self._view(img_msg)
        if desired_encoding == "passthrough":
            return image
        try:
            return cvtColor2(image, img_msg.encoding, desired_encoding)
        except RuntimeError as error:
            raise CvBridgeError(error) from None

    def _view(self, message: Image) -> NDArray[Any]:
        found = _encoding(message.encoding)
        dtype = found.dtype.newbyteorder(">" if message.is_bigendian else "<")
        pixel = dtype.itemsize * found.channels
        step = max(message.step, message.width * pixel)
        needed = (message.height - 1) * step + message.width * pixel if message.height else 0
        if len(message.data) < needed:
            raise CvBridgeError(
                f"an image of {message.width} x {message.height} pixels in {message.encoding} with steps of {step} "
                f"bytes needs {needed} bytes of data, not {len(message.data)}"
            )
        shape: tuple[int, ...] = (message.height, message.width)
        strides: tuple[int, ...] = (step, pixel)
        if found.channels > 1:
            shape, strides = (*shape, found.channels), (*strides, dtype.itemsize)
        image: NDArray[Any] = np.ndarray(shape, dtype, message.data if needed else None, strides=strides)
        return np.ascontiguousarray(image if dtype.isnative else image.astype(found.dtype))

    def cv2_to_imgmsg(self, cvim: NDArray[Any], encoding: str = "passthrough", header: Header | None = None) -> Image:
        """Return a message with an image.

        Parameters
        ----------
        cvim : array of shape (height, width) or (height, width, channels)
            The image.
        encoding
            What its numbers mean; just numbers where "passthrough".
        header
            Of the message.

        Raises
        ------
        TypeError
            When it is not an array.
        CvBridgeError
            When its type does not fit the encoding.
        """
        kind = self._type_of(cvim)
        if encoding == "passthrough":
            encoding = kind
        elif _encoding(encoding).type_name != kind:
            raise CvBridgeError(f"encoding specified as {encoding}, but image has incompatible type {kind}")
        data = array("B")
        data.frombytes(cvim.tobytes() if cvim.size == 0 else np.ascontiguousarray(cvim).data.cast("B"))
        message = Image(
            height=cvim.shape[0],
            width=cvim.shape[1],
            encoding=encoding,
            is_bigendian=cvim.dtype.byteorder == ">" or (sys.byteorder == "big" and cvim.dtype.isnative),
            step=len(data) // cvim.shape[0] if cvim.shape[0] else 0,
            data=data,
        )
        if header is not None:
            message.header = header
        return message

    def _type_of(self, image: NDArray[Any]) -> str:
        if not isinstance(image, (np.ndarray, np.generic)):
            raise TypeError("Your input type is not a numpy array")
        if image.ndim not in (2, 3):
            raise CvBridgeError(f"an image has two or three dimensions, not {image.ndim}")
        return self.dtype_with_channels_to_cvtype2(image.dtype, 1 if image.ndim == 2 else image.shape[2])

    def compressed_imgmsg_to_cv2(
        self, cmprs_img_msg: CompressedImage, desired_encoding: str = "passthrough"
    ) -> NDArray[Any]:
        """Return the image in a message that holds a compressed one.

        Parameters
        ----------
        cmprs_img_msg
            The message.
        desired_encoding
            The encoding of the result; with "passthrough" colours are in the order BGR.

        Raises
        ------
        CvBridgeError
            When there is no such conversion, or the image cannot be read.
        """
        try:
            image, name = decompress(bytes(cmprs_img_msg.data))
            return image if desired_encoding == "passthrough" else cvtColor2(image, name, desired_encoding)
        except RuntimeError as error:
            raise CvBridgeError(error) from None

    def cv2_to_compressed_imgmsg(self, cvim: NDArray[Any], dst_format: str = "jpg") -> CompressedImage:
        """Return a message with an image compressed.

        Parameters
        ----------
        cvim
            The image, colours in the order BGR.
        dst_format
            Such as jpg or png.

        Raises
        ------
        TypeError
            When it is not an array.
        CvBridgeError
            When it cannot be written in that format.
        """
        self._type_of(cvim)
        try:
            data = array("B", compress(cvim, dst_format))
        except RuntimeError as error:
            raise CvBridgeError(error) from None
        return CompressedImage(format=dst_format, data=data)


def _encoding(name: str) -> Any:
    try:
        return encoding(name)
    except RuntimeError as error:
        raise CvBridgeError(error) from None
