"""Files of a planned weld: programs, points, figures and report."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from daidalos.common.errors import UserError
from daidalos.industry.motion.kinematics import confdata
from daidalos.industry.robots.kuka import KUKA_ARMS, controller_angles
from daidalos.industry.welding.krl import components_of, write_krl
from daidalos.industry.welding.planning import Plan
from daidalos.industry.welding.rapid_paths import write_rapid
from daidalos.industry.welding.report import report

_KUKA = {arm.name for arm in KUKA_ARMS}


def write_plan(plan: Plan, folder: Path, name: str, tool_mass: float) -> list[Path]:
    """Write the files of a plan to a folder and return their paths.

    Parameters
    ----------
    plan : Plan
        The plan.
    folder : Path
        Made where it is not there.
    name : str
        Of the path; the programs are named after it.
    tool_mass : float
        [kg]

    Raises
    ------
    UserError
        Where one of the files is there already.
    """
    identifier = "weld_" + re.sub(r"\W", "_", name, flags=re.ASCII)[:16]
    texts: dict[str, str | bytes] = {
        f"{identifier}.csv": _points(plan),
        f"{identifier}.src": _krl(plan, identifier),
        f"{identifier}.mod": _rapid(plan, identifier, tool_mass),
        "plan.json": json.dumps(plan.as_json(), indent=1) + "\n",
        "report.html": report(plan, f"Weld {name}"),
    }
    return write_new(folder, texts)


def write_new(folder: Path, contents: Mapping[str, str | bytes]) -> list[Path]:
    """Write texts and bytes to new files in a folder, all or none, and return their paths.

    Raises
    ------
    UserError
        Where one of them is there already, or the folder cannot be written to.
    """
    for name in contents:
        if (folder / name).exists():
            raise UserError(f"{folder / name}: is there already; choose another folder or remove it")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in contents.items():
            with open(folder / name, "xb") as file:
                file.write(content if isinstance(content, bytes) else content.encode())
    except OSError as error:
        raise UserError(f"{folder}: {error.strerror or error}") from None
    return [folder / name for name in contents]


def _points(plan: Plan) -> str:
    """Return the corrected path as CSV, mm and degrees, with what it corrects."""
    done = plan.correction
    head = ["x_mm", "y_mm", "z_mm", "a_deg", "b_deg", "c_deg", "qx", "qy", "qz", "qw", "path_mm"]
    head += [f"desired_{axis}_mm" for axis in "xyz"]
    head += [f"{state}_{one}_mm" for state in ("before", "after") for one in ("ahead", "across", "along_tool")]
    head += [f"torque_{axis}_nm" for axis in range(1, 7)] + [f"joint_{axis}_deg" for axis in range(1, 7)]
    from scipy.spatial.transform import Rotation

    quaternions = Rotation.from_matrix(done.programmed[:, :3, :3]).as_quat(canonical=True)
    columns = np.concatenate(
        [
            [list(components_of(pose).values()) for pose in done.programmed],
            quaternions,
            1e3 * done.distances[:, None],
            1e3 * done.desired[:, :3, 3],
            1e3 * plan.before,
            1e3 * plan.after,
            done.after.torques,
            np.degrees(done.motors),
        ],
        axis=1,
    )
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([[f"{value + 0.0:.6f}" for value in row] for row in columns])
    return text.getvalue()


def _krl(plan: Plan, name: str) -> str:
    done = plan.correction
    joints = done.motors[0]
    axes = controller_angles(joints) if plan.cell.arm.name in _KUKA else joints
    return write_krl(name, plan.cell.tool, done.programmed, np.degrees(axes), plan.speeds)


def _rapid(plan: Plan, name: str, tool_mass: float) -> str:
    done = plan.correction
    configurations = confdata(plan.cell.arm, done.motors)
    start = np.degrees(done.motors[0])
    return write_rapid(name, plan.cell.tool, tool_mass, done.programmed, configurations, start, plan.speeds)
