"""The exceptions that rclpy's compiled part raises in ROS 2, under the same names."""


class InvalidHandle(Exception):
    """A handle was used after its entity had been destroyed."""


class RCLError(RuntimeError):
    """An operation of the client library failed."""


class RMWError(RuntimeError):
    """An operation of the middleware failed."""


class RCUtilsError(RuntimeError):
    """A utility, such as logging, failed."""


class NodeNameNonExistentError(RCLError):
    """No node of that name is known."""


class UnsupportedEventTypeError(RCLError):
    """The middleware has no such event."""


class UnknownROSArgsError(RuntimeError):
    """Invalid argument between ``--ros-args`` and ``--``."""


class RCLInvalidROSArgsError(RCLError):
    """A ROS argument cannot be read."""


class TimerCancelledError(RCLError):
    """The timer was cancelled and so has no next call."""
