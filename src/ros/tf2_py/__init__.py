"""The buffer of coordinate transforms behind `tf2_ros`, and its exceptions."""

from .buffer_core import BufferCore as BufferCore
from .exceptions import ConnectivityException as ConnectivityException
from .exceptions import ExtrapolationException as ExtrapolationException
from .exceptions import InvalidArgumentException as InvalidArgumentException
from .exceptions import LookupException as LookupException
from .exceptions import TimeoutException as TimeoutException
from .exceptions import TransformException as TransformException

__all__ = [
    "BufferCore",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "TimeoutException",
    "TransformException",
]
