"""Error of robot and world descriptions."""

from __future__ import annotations

from daidalos.common.errors import Location, UserError

_MAX_SHOWN = 500


class DescriptionError(UserError):
    """Unusable description; the message names the location.

    Parameters
    ----------
    message : str
        What is wrong and what was expected.
    source : str
        The file or other origin, as the user knows it; empty when unknown.
    line : int
        Line in `source`, counted from 1; 0 when unknown.
    element : str
        The element as it appears, such as ``<joint name="elbow">``; empty when none.
    """

    def __init__(self, message: str, source: str = "", line: int = 0, element: str = "") -> None:
        message, element = _shortened(message), _shortened(element)
        super().__init__(f"{element}: {message}" if element else message, Location(source or None, line or None))
        self.message = message
        self.source = source
        self.line = line
        self.element = element


def _shortened(text: str) -> str:
    """Return a text, cut where a value of the description makes it long."""
    return text if len(text) <= _MAX_SHOWN else f"{text[:_MAX_SHOWN]}..."
