"""`grinding_studio`: the studio with the height field, the arm, and plots of force and cylinder."""

from __future__ import annotations

from dataclasses import replace

from daidalos.interfaces.library import BUILT_IN
from daidalos.nodes.studio_window import parse, run_studio, studio_parser
from daidalos.studio.plotjuggler_layout import read_plotjuggler
from daidalos.studio.rviz_config import read_rviz

_SHARE = BUILT_IN / "daidalos_grinding"


def main() -> int:
    """Serve the studio and open it."""
    arguments = parse(studio_parser("grinding_studio", "A grinding cell: height field, arm, force and cylinder."))
    plots = read_plotjuggler(_SHARE / "plotjuggler" / "grinding.xml")
    view = read_rviz(_SHARE / "rviz" / "grinding.rviz")
    # Each file would be saved to as itself; the page saves this arrangement as a new one.
    arrangement = replace(view, tabs=plots.tabs, span=plots.span, source="")
    return run_studio("grinding_studio", "scene", arguments, arrangement, layout="grinding")
