"""Results of Nav2's actions from the exceptions of the libraries."""

from __future__ import annotations

from typing import Any

from daidalos.navigation.errors import NavigationError


def set_error(result: Any, error: Exception) -> Any:
    """Set ``error_code`` and ``error_msg`` of an action's result.

    The code is the result's constant of the name that the error's class gives as ``code``, or UNKNOWN.
    """
    name = getattr(error, "code", "UNKNOWN")
    result.error_code = int(getattr(type(result), name, getattr(type(result), "UNKNOWN", 0)))
    result.error_msg = str(error)
    return result


def error_name(result: Any) -> str:
    """Return the name of a result's error code, NONE where there is no error."""
    for name in dir(type(result)):
        if name.isupper() and "__" not in name and getattr(type(result), name) == result.error_code:
            return name
    return "UNKNOWN"


class TransformFailed(NavigationError):
    """A pose cannot be transformed to the required frame."""

    code = "TF_ERROR"
