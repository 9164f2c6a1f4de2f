"""How samples and commands of the simulation meet messages; the parts that all of them share."""

from __future__ import annotations

from array import array
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from daidalos.nodes.conversions import time_message
from daidalos.samples import sensors as samples


@dataclass(frozen=True)
class Outgoing:
    """How a class of samples becomes a message.

    Parameters
    ----------
    message : callable
        Returns the message's class; importing it waits until it is needed.
    convert : callable
        Makes the message.
    """

    message: Callable[[], Any]
    convert: Callable[[Any], Any]


@dataclass(frozen=True)
class Incoming:
    """How a message becomes a command; see `Outgoing`."""

    message: Callable[[], Any]
    convert: Callable[[Any], Any]


def named(package: str, name: str) -> Callable[[], Any]:
    """Return what imports a message's class when it is needed."""

    def load() -> Any:
        return getattr(import_module(f"{package}.msg"), name)

    return load


def header(sample: samples.Sample) -> Any:
    """Return a sample's stamp and frame."""
    from std_msgs.msg import Header

    return Header(stamp=time_message(sample.stamp_ns), frame_id=sample.frame_id)


def vector(values: Any) -> Any:
    """Return three numbers as a ``geometry_msgs/msg/Vector3``."""
    from geometry_msgs.msg import Vector3

    x, y, z = values.tolist()
    return Vector3(x=x, y=y, z=z)


def quaternion(values: Any) -> Any:
    """Return x, y, z, w as a ``geometry_msgs/msg/Quaternion``."""
    from geometry_msgs.msg import Quaternion

    x, y, z, w = values.tolist()
    return Quaternion(x=x, y=y, z=z, w=w)


def floats(values: Any) -> array[float]:
    """Return numbers as a message's field of 32 bit floats."""
    result = array("f")
    result.frombytes(np.ascontiguousarray(values, dtype=np.float32).tobytes())
    return result


def array_bytes(values: Any) -> array[int]:
    """Return the memory of an array as a message's field of bytes."""
    result = array("B")
    result.frombytes(np.ascontiguousarray(values).data.cast("B"))
    return result
