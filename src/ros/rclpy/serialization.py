"""Messages as CDR bytes."""

from typing import Any

from daidalos.interfaces.codec import codec_of
from rclpy.type_support import check_for_type_support


def serialize_message(message: Any) -> bytes:
    """Return a message's CDR bytes, with their encapsulation header.

    Raises
    ------
    CdrError
        When a field holds what its type cannot.
    """
    check_for_type_support(type(message))
    return codec_of(type(message)).encode(message)


def deserialize_message(serialized_message: bytes, message_type: Any) -> Any:
    """Return the message that CDR bytes hold.

    Raises
    ------
    CdrError
        When they hold no message of the type.
    """
    check_for_type_support(message_type)
    return codec_of(message_type).decode(serialized_message)
