"""Paths in programs in KRL, the language of KUKA's robots: reader and writer.

Read are LIN, SLIN, PTP, SPTP, CIRC and SCIRC with positions written out or named by declarations in the program or in
the .dat file beside it, and $BASE. Positions are those of the tool's centre point in $BASE.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError, read_text
from daidalos.industry.welding.path_runs import PathRuns, arc

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_COMPONENT = re.compile(rf"\b([A-Z]\w*)\s+({_NUMBER})(?=\s*[,}}])", re.IGNORECASE)
_POSITION = re.compile(r"(?:DECL\s+)?(?:GLOBAL\s+)?(?:E6POS|POS|FRAME)\s+(\w+)\s*=\s*(\{[^}]*\})", re.IGNORECASE)
_ASSIGNED = re.compile(r"^(\$?\w+)\s*=\s*(\{[^}]*\}|\$NULLFRAME)", re.IGNORECASE)
_MOTION = re.compile(r"^(S?(?:LIN|PTP|CIRC))(?:_REL)?\b\s*(.*)$", re.IGNORECASE)
_TARGET = re.compile(r"\{[^}]*\}|[A-Za-z_]\w*")


def read_krl(path: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the positions (n, 3) [m] and orientations (n, 3, 3) of the tool in the base on the longest path.

    A path begins after a movement by the joints, at its pose where that is written; points on circles are computed
    every 3 degrees.

    Raises
    ------
    DocumentError
        Where a position is not declared or incomplete; the message names the line.
    """
    declared: dict[str, dict[str, float]] = {}
    data = path.with_suffix(".dat")
    for file in (data, path):
        if file != data or data.exists():
            declared.update(_declarations(read_text(file)))
    base = np.eye(4)
    runs = PathRuns()
    for number, line in _lines(read_text(path)):
        assigned = _ASSIGNED.match(line)
        if assigned and assigned[1].upper() == "$BASE":
            parts = {} if assigned[2].upper() == "$NULLFRAME" else _components(assigned[2])
            base = pose_of({**dict.fromkeys("XYZABC", 0.0), **parts})
        motion = _MOTION.match(line)
        if motion is None:
            continue
        kind = motion[1].upper().lstrip("S")
        if "_REL" in line.upper().split("{", maxsplit=1)[0]:
            raise DocumentError(f"{motion[1]}_REL is not read; write positions in $BASE", str(path), number, 1)
        targets = [
            _target(text, declared, path, number) for text in _TARGET.findall(motion[2])[: 2 if kind == "CIRC" else 1]
        ]
        if kind == "PTP":
            runs.begin(base @ pose_of(targets[0]) if targets and _is_pose(targets[0]) else None)
            continue
        _require(targets, kind, runs.last is None, path, number)
        filled = [_filled(target, targets[-1], base, runs.last) for target in targets]
        runs.add(arc(runs.last, *filled) if kind == "CIRC" and runs.last is not None else filled)
    return runs.longest()


def _declarations(text: str) -> dict[str, dict[str, float]]:
    return {match[1].upper(): _components(match[2]) for match in _POSITION.finditer(text)}


def _components(text: str) -> dict[str, float]:
    return {match[1].upper(): float(match[2]) for match in _COMPONENT.finditer(text)}


def _lines(text: str) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(text.splitlines(), 1):
        code = line.split(";", maxsplit=1)[0].strip()
        if code and not code.startswith("&"):
            yield number, code


def _target(text: str, declared: dict[str, dict[str, float]], path: Path, line: int) -> dict[str, float]:
    if text.startswith("{"):
        return _components(text)
    if text.upper() not in declared:
        raise DocumentError(f"position '{text}' is not declared here or in {path.stem}.dat", str(path), line, 1)
    return declared[text.upper()]


def _is_pose(target: dict[str, float]) -> bool:
    return all(axis in target for axis in "XYZABC")


def _require(targets: Sequence[dict[str, float]], kind: str, begins: bool, path: Path, line: int) -> None:
    if len(targets) < (2 if kind == "CIRC" else 1):
        raise DocumentError(f"{kind} needs {'two positions' if kind == 'CIRC' else 'a position'}", str(path), line, 1)
    if begins and (kind == "CIRC" or not _is_pose(targets[-1])):
        raise DocumentError("the path begins here, so X, Y, Z, A, B and C are needed", str(path), line, 1)


def _filled(
    target: dict[str, float], goal: dict[str, float], base: NDArray[np.float64], last: NDArray[np.float64] | None
) -> NDArray[np.float64]:
    """Return a pose in the robot's base; what a target leaves out is as at its goal, or at the last position."""
    before = dict.fromkeys("XYZABC", 0.0) if last is None else components_of(np.linalg.inv(base) @ last)
    return base @ pose_of({**before, **{key: goal[key] for key in "ABC" if key in goal}, **target})


def pose_of(parts: dict[str, float]) -> NDArray[np.float64]:
    """Return the pose (4, 4) of X, Y, Z [mm] and A, B, C [deg]."""
    from scipy.spatial.transform import Rotation

    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_euler("ZYX", [parts["A"], parts["B"], parts["C"]], degrees=True).as_matrix()
    pose[:3, 3] = 1e-3 * np.array([parts["X"], parts["Y"], parts["Z"]])
    return pose


def components_of(pose: NDArray[np.float64]) -> dict[str, float]:
    """Return X, Y, Z [mm] and A, B, C [deg] of a pose (4, 4)."""
    from scipy.spatial.transform import Rotation

    angles = Rotation.from_matrix(pose[:3, :3]).as_euler("ZYX", degrees=True)
    return dict(zip("XYZABC", (*(1e3 * pose[:3, 3]), *angles), strict=True))


def write_krl(
    name: str,
    tool: NDArray[np.float64],
    poses: NDArray[np.float64],
    start_axes: NDArray[np.float64],
    speeds: NDArray[np.float64],
) -> str:
    """Return a program that moves to the first pose by its axes and then along lines.

    Parameters
    ----------
    name : str
        Of the program, letters, digits and underscores.
    tool : array of shape (4, 4)
        The tool's centre point in the flange.
    poses : array of shape (n, 4, 4)
        Of the tool in the robot's base.
    start_axes : array of shape (6,)
        A1 to A6 at the first pose [deg].
    speeds : array of shape (n,)
        Of the tool to each pose [m/s].
    """
    axes = ",".join(f"A{number} {value:.4f}" for number, value in enumerate(start_axes, 1))
    lines = [
        "&ACCESS RVP",
        f"DEF {name}()",
        "; corrected path, written by daidalos weld plan",
        "$BASE=$NULLFRAME",
        f"$TOOL={_aggregate(tool)}",
        f"$VEL.CP={speeds[0]:.6f}",
        "$APO.CDIS=0.5",
        f"PTP {{{axes}}}",
    ]
    before = f"{speeds[0]:.6f}"
    for number, (pose, speed) in enumerate(zip(poses, speeds, strict=True), 1):
        if f"{speed:.6f}" != before:
            before = f"{speed:.6f}"
            lines.append(f"$VEL.CP={before}")
        lines.append(f"LIN {_aggregate(pose)}{' C_DIS' if number < len(poses) else ''}")
    lines.append("END")
    return "\n".join(lines) + "\n"


def _aggregate(pose: NDArray[np.float64]) -> str:
    return "{" + ",".join(f"{axis} {value:.4f}" for axis, value in components_of(pose).items()) + "}"
