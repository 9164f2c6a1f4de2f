"""Transforms between coordinate frames over time: publish, receive, store and look them up."""

from typing import TYPE_CHECKING

from rclpy.impl.lazy_reexport import lazy_reexport
from tf2_py import BufferCore as BufferCore
from tf2_py import ConnectivityException as ConnectivityException
from tf2_py import ExtrapolationException as ExtrapolationException
from tf2_py import InvalidArgumentException as InvalidArgumentException
from tf2_py import LookupException as LookupException
from tf2_py import TimeoutException as TimeoutException
from tf2_py import TransformException as TransformException

from .buffer import Buffer as Buffer
from .buffer_interface import BufferInterface as BufferInterface
from .buffer_interface import ConvertRegistration as ConvertRegistration
from .buffer_interface import NotImplementedException as NotImplementedException
from .buffer_interface import Stamped as Stamped
from .buffer_interface import TransformRegistration as TransformRegistration
from .buffer_interface import TypeException as TypeException
from .buffer_interface import convert as convert
from .static_transform_broadcaster import StaticTransformBroadcaster as StaticTransformBroadcaster
from .static_transform_listener import StaticTransformListener as StaticTransformListener
from .transform_broadcaster import TransformBroadcaster as TransformBroadcaster
from .transform_listener import DEFAULT_STATIC_TF_TOPIC as DEFAULT_STATIC_TF_TOPIC
from .transform_listener import DEFAULT_TF_TOPIC as DEFAULT_TF_TOPIC
from .transform_listener import TransformListener as TransformListener

if TYPE_CHECKING:
    from .buffer_client import BufferClient as BufferClient
    from .buffer_server import BufferServer as BufferServer

__all__ = [
    "DEFAULT_STATIC_TF_TOPIC",
    "DEFAULT_TF_TOPIC",
    "Buffer",
    "BufferClient",
    "BufferCore",
    "BufferInterface",
    "BufferServer",
    "ConnectivityException",
    "ConvertRegistration",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NotImplementedException",
    "Stamped",
    "StaticTransformBroadcaster",
    "StaticTransformListener",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TransformRegistration",
    "TypeException",
    "convert",
]


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__,
        {
            "geometry_msgs.msg": ("TransformStamped",),
            "rclpy.duration": ("Duration",),
            "rclpy.time": ("Time",),
            # Actions take as long to import as everything else here.
            "tf2_ros.buffer_client": ("BufferClient",),
            "tf2_ros.buffer_server": ("BufferServer",),
        },
    )
