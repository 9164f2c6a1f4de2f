"""Guided calibration of tools and work objects: touches of a known tool give it back, and bad geometry is named."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from daidalos.cli.daidalos import main
from daidalos.industry.calibration import CalibrationError
from daidalos.industry.rapid.literals import parse_literals
from daidalos.industry.rapid.teaching import teach_tool, teach_work_object, tool_prompts

TIP = np.array([0.010, -0.020, 0.150])
POINT = np.array([0.4, 0.1, 0.2])
DOWN = Rotation.from_euler("y", 180, degrees=True)


def flange(rotation: Rotation, tip: np.ndarray) -> np.ndarray:
    """Return the flange's pose with that rotation and the tip there."""
    pose = np.eye(4)
    pose[:3, :3] = rotation.as_matrix()
    pose[:3, 3] = tip - pose[:3, :3] @ TIP
    return pose


def touches(tilt: float, noise: float = 0.0, count: int = 4) -> Iterator[np.ndarray]:
    """Yield poses of touches with tilts in degrees about axes all round, and noise [m]."""
    generator = np.random.default_rng(3)
    for i in range(count):
        turn = Rotation.from_euler("ZXZ", [360.0 * i / count, tilt, -360.0 * i / count], degrees=True)
        yield flange(DOWN * turn, POINT + generator.normal(0.0, noise, 3))


def value_of(declaration: str) -> list[list[float]]:
    """Return the value of a declaration."""
    return list(parse_literals(f"[{declaration.partition(':=')[2].rstrip(';')}]")[0])


def test_the_tip_is_found() -> None:
    result = teach_tool("tPen", list(touches(40.0)), "tcp", 0.5)
    _, (position, orientation), load = value_of(result.declaration)
    assert np.abs(np.array(position) - 1e3 * TIP).max() < 1e-3
    assert orientation == [1.0, 0.0, 0.0, 0.0]
    assert load[0] == 0.5
    assert result.warnings == []


@pytest.mark.parametrize("method", ["z", "zx"])
def test_the_axes_are_found(method: str) -> None:
    tool = Rotation.from_euler("zyx", [0.0 if method == "z" else 50.0, 25.0, 0.0], degrees=True)
    poses = list(touches(40.0))
    for axis in ("z", "zx")[len(method) - 1]:
        rotation = DOWN * Rotation.from_euler("x", 10.0, degrees=True)
        direction = (rotation * tool).apply(np.eye(3)["xyz".index(axis)])
        poses.append(flange(rotation, POINT - 0.05 * direction))
    assert len(poses) == len(tool_prompts(4, method))
    result = teach_tool("tPen", poses, method)
    _, (_, (w, x, y, z)), _ = value_of(result.declaration)
    found = Rotation.from_quat([x, y, z, w])
    assert (found * tool.inv()).magnitude() < 1e-5


def test_small_tilts_and_wrong_touches_are_named() -> None:
    assert "bad geometry: condition" in teach_tool("t", list(touches(3.0, 1e-5)), "tcp").warnings[0]
    assert any("one of them is wrong" in one for one in teach_tool("t", list(touches(30.0, 5e-3)), "tcp").warnings)
    with pytest.raises(CalibrationError, match="nearly the same orientation"):
        teach_tool("t", [flange(DOWN, POINT)] * 4, "tcp")
    with pytest.raises(CalibrationError, match="move at least 10 mm away"):
        teach_tool("t", [*touches(30.0), flange(DOWN, POINT)], "z")


def test_deviations_are_those_of_many_calibrations() -> None:
    noise = 3e-4
    generator = np.random.default_rng(5)
    found, stated = [], []
    for _ in range(300):
        poses = [one.copy() for one in touches(30.0, count=8)]
        for one in poses:
            one[:3, 3] += generator.normal(0.0, noise, 3)
        result = teach_tool("t", poses, "tcp")
        found.append(value_of(result.declaration)[1][0])
        stated.append([float(one) for one in result.lines[1].partition("[")[2].partition("]")[0].split(",")])
    assert np.std(found, axis=0) == pytest.approx(np.sqrt(np.mean(np.square(stated), axis=0)), rel=0.15)


def test_the_work_object_and_its_deviation() -> None:
    frame = np.eye(4)
    frame[:3, :3] = Rotation.from_euler("zyx", [30.0, 5.0, -10.0], degrees=True).as_matrix()
    frame[:3, 3] = [0.3, 0.1, 0.05]
    tool = np.eye(4)
    tool[:3, 3] = TIP
    points = [[0.02, 0, 0], [0.3, 0, 0], [0, 0.2, 0]]
    tips = [frame[:3, :3] @ np.array(one) + frame[:3, 3] for one in points]
    poses = [flange(DOWN * Rotation.from_euler("x", 7.0 * i, degrees=True), tip) for i, tip in enumerate(tips)]
    result = teach_work_object("wSheet", poses, tool)
    origin, (w, x, y, z) = value_of(result.declaration)[3]
    assert np.abs(np.array(origin) - 1e3 * frame[:3, 3]).max() < 1e-3
    assert (Rotation.from_quat([x, y, z, w]) * Rotation.from_matrix(frame[:3, :3]).inv()).magnitude() < 1e-5
    assert result.warnings == []
    generator = np.random.default_rng(1)
    origins = []
    for _ in range(500):
        moved = [one.copy() for one in poses]
        for one in moved:
            one[:3, 3] += generator.normal(0.0, 3e-4, 3)
        origins.append(value_of(teach_work_object("w", moved, tool).declaration)[3][0])
    stated = [float(one) for one in result.lines[1].partition("[")[2].partition("]")[0].split(",")]
    assert np.std(origins, axis=0) == pytest.approx(stated, rel=0.15)


def test_points_that_are_close_or_nearly_in_line_are_named() -> None:
    tips = [[0.3, 0.0, 0.1], [0.33, 0.0, 0.1], [0.6, 0.02, 0.1]]
    poses = [flange(DOWN, np.array(one)) for one in tips]
    tool = np.eye(4)
    tool[:3, 3] = TIP
    first, second = teach_work_object("w", poses, tool).warnings
    assert "two points are 30 mm apart" in first
    assert "y1 is 4 deg from the x axis" in second


def recorded(path: Path, poses: list[np.ndarray]) -> Path:
    """Write poses of the flange as robtargets."""
    lines = []
    for number, pose in enumerate(poses):
        x, y, z, w = Rotation.from_matrix(pose[:3, :3]).as_quat()
        at = ",".join(f"{1e3 * one:.6f}" for one in pose[:3, 3])
        lines.append(
            f"CONST robtarget p{number} := [[{at}],[{w:.9f},{x:.9f},{y:.9f},{z:.9f}],[0,0,0,0],"
            "[9E9,9E9,9E9,9E9,9E9,9E9]];"
        )
    path.write_text("MODULE poses\n" + "\n".join(lines) + "\nENDMODULE\n")
    return path


def test_the_command_writes_adds_and_replaces(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    poses, module = recorded(tmp_path / "poses.mod", list(touches(40.0))), tmp_path / "cell.mod"
    command = ["rapid", "calibrate", "tool", "tPen", "-o", str(module), "--poses", str(poses)]
    assert main(command) == 0
    assert module.read_text() == (
        "MODULE cell\n  PERS tooldata tPen:=[TRUE,[[10,-20,150],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\nENDMODULE\n"
    )
    assert capsys.readouterr().out.splitlines()[0] == "tip in the flange: [10,-20,150] mm"
    before = module.read_text()
    assert main(command) == 2
    assert f"{module}:2: 'tPen' is declared; add --force" in capsys.readouterr().err
    assert module.read_text() == before
    module.write_text(before.replace("150", "1").replace("tPen", "TPEN") + "! end\n")
    assert main([*command, "--force"]) == 0
    assert module.read_text() == before.replace("tPen", "TPEN") + "! end\n"
    assert main([*command[:3], "tOther", *command[4:]]) == 0
    assert module.read_text().count("PERS tooldata") == 2
    assert main(["rapid", "check", str(module)]) == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["tool", "5x"], "'5x' is no name in RAPID"),
        (["tool", "t", "--points", "3"], "--points takes 4 to 20"),
        (["tool", "t", "--points", "5"], "declares 4 targets, and 5 are needed"),
        (["tool", "t", "--robot", "irb121"], "there is no arm 'irb121'; did you mean 'irb120'"),
        (["tool", "t", "--mass", "nan"], "--mass takes more than 0 kg"),
        (["wobj", "w", "--tool", "0", "0", "inf"], "--tool takes finite millimetres"),
        (["wobj", "w", "--tool", "0", "0", "1", "--noise", "0"], "--noise takes more than 0 mm"),
    ],
)
def test_what_the_command_refuses(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    poses, module = recorded(tmp_path / "poses.mod", list(touches(40.0))), tmp_path / "cell.mod"
    assert main(["rapid", "calibrate", *arguments, "-o", str(module), "--poses", str(poses)]) == 2
    assert message in capsys.readouterr().err
    assert not module.exists()
