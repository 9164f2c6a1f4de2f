"""The layout of a page that a file asks for: fixed frame, displays, camera and plots."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from daidalos.common.errors import Location, UserError
from daidalos.studio.records import to_json

Value = str | float | bool


class ArrangementError(UserError):
    """A layout file that cannot be read; the text names the file, the line and what is wrong."""

    def __init__(self, path: Path | str, line: int | None, what: str) -> None:
        super().__init__(what, Location(str(path), line))


@dataclass(frozen=True)
class Display:
    """One display of the 3-D view.

    Parameters
    ----------
    type : str
        RViz's class without its package, e.g. ``LaserScan``; with it where the page has no such display.
    name : str
    enabled : bool
    settings : dict
        Values by the keys that the page's display of this type has, ``topic`` among them; what is left out has
        the page's default.
    origin : str
        Its place in the file that it was read from; empty for one that was added.
    """

    type: str
    name: str
    enabled: bool = True
    settings: dict[str, Value] = field(default_factory=dict)
    origin: str = ""


@dataclass(frozen=True)
class View:
    """The pose of the camera.

    Parameters
    ----------
    kind : "orbit" or "top"
    focus : tuple of 3 floats
        The point in the fixed frame that it looks at [m].
    distance : float
        [m].
    yaw, pitch : float
        Of the camera as seen from the focus, about the vertical and above the horizon [rad].
    """

    kind: Literal["orbit", "top"]
    focus: tuple[float, float, float]
    distance: float
    yaw: float = 0.0
    pitch: float = 0.0


@dataclass(frozen=True)
class Curve:
    """One curve of a plot: a field over time, or one field over another.

    Parameters
    ----------
    path : str
        Topic and fields, e.g. ``/odom/pose/pose/position/x``.
    color : str
        ``#rrggbb``; empty: the next free one.
    over : str
        Path of the abscissa; empty for time.
    """

    path: str
    color: str = ""
    over: str = ""


@dataclass(frozen=True)
class Plot:
    """One plot.

    Parameters
    ----------
    curves : tuple of Curve
    origin : str
        Its number in the file that it was read from; empty for one that was added.
    """

    curves: tuple[Curve, ...]
    origin: str = ""


@dataclass(frozen=True)
class Split:
    """Parts beside or below each other, and the share of the space of each."""

    across: bool
    shares: tuple[float, ...]
    parts: tuple[Plot | Split, ...]


@dataclass(frozen=True)
class Arrangement:
    """What the page shows when it opens.

    Parameters
    ----------
    fixed_frame : str
        Empty: the page selects one.
    displays : tuple of Display, or None
        None: the page's default.
    view : View or None
    followed : str
        The frame that the camera moves along with; empty: none.
    tabs : tuple of (str, Plot or Split)
        Titles and contents of the tabs with plots.
    span : float
        Time span of plots over time [s]; 0: the page's default.
    panels : tuple of str
        Panels that the page opens besides its default ones.
    left_out : tuple of str
        What the file asks for and the studio does not have, for a message to the user.
    source : str
        The text of the file that it was read from, so that saving keeps what is not known here.
    """

    fixed_frame: str = ""
    displays: tuple[Display, ...] | None = None
    view: View | None = None
    followed: str = ""
    tabs: tuple[tuple[str, Plot | Split], ...] = ()
    span: float = 0.0
    panels: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()
    source: str = ""

    def to_json(self) -> dict[str, Any]:
        """Return what the page reads; its types are generated from the classes above."""
        record: dict[str, Any] = to_json(self)
        return record
