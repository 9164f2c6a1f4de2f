"""Interface of transform sources, and registries of transformable and convertible types."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import TYPE_CHECKING, Any, ClassVar

from rclpy.duration import Duration
from rclpy.impl.lazy_reexport import lazy_reexport

if TYPE_CHECKING:
    from geometry_msgs.msg import TransformStamped
    from rclpy.time import Time

NO_WAIT = Duration()
_PACKAGES = {"geometry_msgs": "tf2_geometry_msgs", "sensor_msgs": "tf2_sensor_msgs"}
"""Which package, once imported, registers the messages of which."""


class BufferInterface:
    """Base of what transforms can be had from: it transforms messages by them."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self, object_stamped: Any, target_frame: str, timeout: Duration = NO_WAIT, new_type: Any = None
    ) -> Any:
        """Transform a message with a header into another frame.

        Parameters
        ----------
        object_stamped
            The message; its package must be registered, for instance by ``import tf2_geometry_msgs``.
        target_frame
            The frame to transform into.
        timeout
            How long to wait for the transform.
        new_type
            The type to convert the result to.

        Raises
        ------
        TypeException
            When there is no transformation of, or conversion from, the message's type.
        TransformException
            When there is no transform.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        transform = self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout)
        result = do_transform(object_stamped, transform)
        return result if new_type is None else convert(result, new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Time,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
        new_type: Any = None,
    ) -> Any:
        """Transform a message with a header into another frame at another time.

        Parameters
        ----------
        target_time
            When the target frame is meant.
        fixed_frame
            The frame that does not move between the two times.
        object_stamped, target_frame, timeout, new_type
            As in `transform`.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        transform = self.lookup_transform_full(
            target_frame, target_time, header.frame_id, header.stamp, fixed_frame, timeout
        )
        result = do_transform(object_stamped, transform)
        return result if new_type is None else convert(result, new_type)

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time, timeout: Duration = NO_WAIT
    ) -> TransformStamped:
        """Return the transform that takes coordinates in the source frame to the target frame."""
        raise NotImplementedException()

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
    ) -> TransformStamped:
        """Return the transform from the source frame at one time to the target frame at another."""
        raise NotImplementedException()

    def can_transform(self, target_frame: str, source_frame: str, time: Time, timeout: Duration = NO_WAIT) -> bool:
        """Return whether `lookup_transform` would find the transform."""
        raise NotImplementedException()

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Time,
        source_frame: str,
        source_time: Time,
        fixed_frame: str,
        timeout: Duration = NO_WAIT,
    ) -> bool:
        """Return whether `lookup_transform_full` would find the transform."""
        raise NotImplementedException()


def Stamped(obj: Any, stamp: Any, frame_id: str) -> Any:
    """Add a header to an object, and return the object."""
    from std_msgs.msg import Header

    obj.header = Header(frame_id=frame_id, stamp=stamp)
    return obj


class TypeException(Exception):
    """There is no transformation or conversion of a type."""

    def __init__(self, errstr: str) -> None:
        super().__init__(errstr)
        self.errstr = errstr


class NotImplementedException(Exception):
    """A subclass of `BufferInterface` lacks a method."""

    def __init__(self) -> None:
        self.errstr = "CanTransform or LookupTransform not implemented"
        super().__init__(self.errstr)


class TransformRegistration:
    """Registry of transformation functions by type; all instances share one registry."""

    _callbacks: ClassVar[dict[Any, Callable[[Any, TransformStamped], Any]]] = {}

    def print_me(self) -> None:
        """Print the register."""
        print(self._callbacks)  # noqa: T201

    def add(self, key: Any, callback: Callable[[Any, TransformStamped], Any]) -> None:
        """Register that ``callback(object, transform)`` transforms objects of the type `key`."""
        self._callbacks[key] = callback

    def get(self, key: Any) -> Callable[[Any, TransformStamped], Any]:
        """Return what transforms a type.

        Raises
        ------
        TypeException
            When nothing does.
        """
        return _registered(self._callbacks, key)


class ConvertRegistration:
    """Registry of conversion functions between types; all instances share one registry."""

    _to_msg: ClassVar[dict[Any, Callable[[Any], Any]]] = {}
    _from_msg: ClassVar[dict[Any, Callable[[Any], Any]]] = {}
    _direct: ClassVar[dict[Any, Callable[[Any], Any]]] = {}

    def add_from_msg(self, key: Any, callback: Callable[[Any], Any]) -> None:
        """Register that ``callback(message)`` returns an object of the type `key`."""
        self._from_msg[key] = callback

    def add_to_msg(self, key: Any, callback: Callable[[Any], Any]) -> None:
        """Register that ``callback(object)`` returns the message of an object of the type `key`."""
        self._to_msg[key] = callback

    def add_convert(self, key: tuple[Any, Any], callback: Callable[[Any], Any]) -> None:
        """Register that ``callback(object)`` converts between the two types ``key = (from, to)``."""
        self._direct[key] = callback

    def get_from_msg(self, key: Any) -> Callable[[Any], Any]:
        """Return what makes an object of a type from a message; `TypeException` when nothing does."""
        return _registered(self._from_msg, key)

    def get_to_msg(self, key: Any) -> Callable[[Any], Any]:
        """Return what makes a message from an object of a type; `TypeException` when nothing does."""
        return _registered(self._to_msg, key)

    def get_convert(self, key: tuple[Any, Any]) -> Callable[[Any], Any]:
        """Return what converts between two types; `TypeException` when nothing does."""
        return _registered(self._direct, key)


def _registered(register: dict[Any, Callable[..., Any]], key: Any) -> Callable[..., Any]:
    try:
        return register[key]
    except KeyError:
        pass
    package = _PACKAGES.get(getattr(key, "__module__", "").partition(".")[0])
    hint = f"; 'import {package}' loads those of its package" if package else ""
    raise TypeException(f"Type {key} is not loaded or supported{hint}")


def convert(a: Any, b_type: Any) -> Any:
    """Return an object converted to a type, or a copy when it is of that type.

    Raises
    ------
    TypeException
        When nothing converts it.
    """
    registration = ConvertRegistration()
    try:
        direct = registration.get_convert((type(a), b_type))
    except TypeException:
        if type(a) is b_type:
            return deepcopy(a)
        to_message = registration.get_to_msg(type(a))
        from_message = registration.get_from_msg(b_type)
        return from_message(to_message(a))
    return direct(a)


if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(__name__, {"geometry_msgs.msg": ("TransformStamped",), "rclpy.time": ("Time",)})
