"""Why a transform cannot be had."""


class TransformException(Exception):
    """Base of all exceptions of transforms."""


class ConnectivityException(TransformException):
    """The two frames are not connected."""


class LookupException(TransformException):
    """A frame is unknown, or the frames form a loop."""


class ExtrapolationException(TransformException):
    """There is no data at, or on both sides of, the time that was asked for."""


class InvalidArgumentException(TransformException):
    """A frame's name breaks the rules."""


class TimeoutException(TransformException):
    """There was no answer in time."""
