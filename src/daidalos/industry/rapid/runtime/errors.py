"""Errors of a running program, by the names that its error handlers compare ERRNO with."""

from __future__ import annotations

import functools

from daidalos.industry.rapid import predefined
from daidalos.industry.rapid.symbols import DataSymbol


class RapidError(Exception):
    """Error that an error handler can recover from.

    Parameters
    ----------
    name
        Such as ``ERR_DIVZERO``, or the number of an error of the program's own.
    message
        What has happened.
    """

    def __init__(self, name: str | float, message: str) -> None:
        super().__init__(message)
        self.number = float(name) if isinstance(name, int | float) else error_number(name)
        self.name = error_name(self.number)
        self.message = message
        self.is_propagated = False
        """Whether the routine that it comes from has handed it on by RAISE."""


class FatalError(Exception):
    """Error that stops the program, whatever its handlers are."""


class ProgramEnd(Exception):
    """End of execution by EXIT, ExitCycle or Stop; `reason` is the instruction."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


class Jump(Exception):
    """Jump to a label around the block that raises it."""


@functools.cache
def error_number(name: str) -> float:
    """Return the value of an error's name; 0 where it is not known."""
    symbol = predefined.find(name.lower())
    return float(symbol.value) if isinstance(symbol, DataSymbol) and symbol.value else 0.0


@functools.cache
def _names() -> dict[float, str]:
    symbols = (predefined.find(name.lower()) for name in predefined.names() if name.startswith("ERR_"))
    return {float(one.value): one.name for one in symbols if isinstance(one, DataSymbol) and one.type.name == "errnum"}


def error_name(number: float) -> str:
    """Return the name of an error number, or the number as text."""
    return _names().get(number, f"{number:g}")


def as_rapid_error(error: Exception) -> RapidError:
    """Return the error of RAPID that an error of Python's stands for."""
    if isinstance(error, RapidError):
        return error
    if isinstance(error, ZeroDivisionError):
        return RapidError("ERR_DIVZERO", "division by zero")
    if isinstance(error, IndexError):
        return RapidError("ERR_OUTOFBND", "an array index is out of bounds")
    if isinstance(error, OverflowError):
        return RapidError("ERR_NUM_LIMIT", "a number is too large")
    return RapidError("ERR_ARGVALERR", f"a value does not fit: {error}")


RECOVERABLE = (RapidError, ZeroDivisionError, IndexError, OverflowError)
"""What a statement may raise, and an error handler can recover from."""
