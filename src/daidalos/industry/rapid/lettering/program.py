"""The program that writes strokes on a sheet with a pen."""

from __future__ import annotations

import math

from daidalos.industry.rapid.lettering.strokes import Point, Stroke

_SMOOTH = math.radians(25.0)
"""Turn at a corner up to which the pen goes through without stopping [rad]."""

LIFT = 10.0
"""Height of the pen above the sheet between strokes [mm]."""


def write_program(
    strokes: list[Stroke], name: str, sheet: tuple[float, float, float], pen_length: float, speed: float
) -> str:
    """Return the module that draws strokes.

    Parameters
    ----------
    strokes
        What is drawn [mm], on the sheet.
    name
        Name of the module.
    sheet
        Origin of the sheet in the base [mm]; its x axis is against y of the base, so that the writing is upright as
        seen from the robot.
    pen_length
        From the flange to the tip of the pen [mm].
    speed
        Speed of drawing [mm/s].
    """
    x, y, z = sheet
    lines = [
        f"MODULE {name}",
        f"  PERS tooldata tPen := [TRUE,[[0,0,{pen_length:g}],[1,0,0,0]],[0.3,[0,0,50],[1,0,0,0],0,0,0]];",
        f'  TASK PERS wobjdata wSheet := [FALSE,TRUE,"",[[{x:g},{y:g},{z:g}],[0.70710678,0,0,-0.70710678]],'
        "[[0,0,0],[1,0,0,0]]];",
        "  CONST zonedata zPen := [FALSE,0.1,0.1,0.1,0.01,0.1,0.01];",
        f"  CONST speeddata vPen := [{speed:g},500,5000,1000];",
        "  CONST jointtarget jRest := [[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];",
        "  CONST robtarget pSheet := [[0,0,0],[0,0.70710678,-0.70710678,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];",
        "",
        "  PROC main()",
        "    ConfJ \\Off;",
        "    ConfL \\Off;",
        "    MoveAbsJ jRest, v1000, fine, tPen;",
    ]
    for stroke in strokes:
        lines += _stroke_lines(stroke)
    lines += ["    MoveAbsJ jRest, v1000, fine, tPen;", "  ENDPROC", "ENDMODULE", ""]
    return "\n".join(lines)


def _stroke_lines(stroke: Stroke) -> list[str]:
    points = stroke.points
    lines = [
        _move("MoveJ", points[0], LIFT, "v500", "fine"),
        _move("MoveL", points[0], 0.0, "v50", "fine"),
    ]
    for n in range(1, len(points)):
        is_smooth = n < len(points) - 1 and _turn(points[n - 1], points[n], points[n + 1]) < _SMOOTH
        lines.append(_move("MoveL", points[n], 0.0, "vPen", "zPen" if is_smooth else "fine"))
    lines.append(_move("MoveL", points[-1], LIFT, "v200", "fine"))
    return lines


def _move(instruction: str, point: Point, height: float, speed: str, zone: str) -> str:
    x, y = (f"{round(one, 3) + 0.0:g}" for one in point)
    return f"    {instruction} Offs(pSheet, {x}, {y}, {height:g}), {speed}, {zone}, tPen \\WObj:=wSheet;"


def _turn(a: Point, b: Point, c: Point) -> float:
    """Return the angle between two lines one after the other [rad]."""
    first, second = (b[0] - a[0], b[1] - a[1]), (c[0] - b[0], c[1] - b[1])
    cross, dot = first[0] * second[1] - first[1] * second[0], first[0] * second[0] + first[1] * second[1]
    return abs(math.atan2(cross, dot))
