"""External axes: they move in proportion to the arm, within their ranges and speeds."""

from pathlib import Path

import pytest

from daidalos.cli.daidalos import main
from daidalos.industry.rapid.runtime.arm_robot import ArmRobot
from daidalos.industry.rapid.runtime.external_axes import parse_axis
from daidalos.industry.robots import arm_named

from .running import run

AT = "[[350,{},300],[0,0,1,0],[0,0,0,0],[{},{},9E9,9E9,9E9,9E9]]"
AXES = dict([parse_axis("a=linear,0,4000,1000"), parse_axis("b=turn,-180,180,90")])
START = f"ConfL \\Off; ConfJ \\Off; MoveJ {AT.format(-100, '9E9', '9E9')}, v1000, fine, tool0; ClkStart c;"


def on_track(lines: str) -> tuple[str, list[str], ArmRobot]:
    """Run lines on an arm with a track and a turntable; return how that ended, what was written, and the arm."""
    robot = ArmRobot(arm_named("irb120"), external=AXES)
    outcome, found = run(f"{START} {lines}", "VAR clock c; VAR intnum i; VAR jointtarget j;", robot=robot)
    return outcome.message or outcome.reason, found, robot


def test_they_arrive_with_the_arm_and_the_slowest_sets_the_time() -> None:
    lines = f"""MoveL {AT.format(100, 2000, 45)}, v1000, z50, tool0; TPWrite "" \\Num:=ClkRead(c);
    j := CJointT(); TPWrite ValToStr(j.extax); MoveL {AT.format(-100, "9E9", "9E9")}, v1000, fine, tool0;
    j := CJointT(); TPWrite ValToStr(j.extax);"""
    end, (seconds, first, second), _ = on_track(lines)
    assert end == "end"
    assert 2.0 < float(seconds) < 2.3
    assert first == second == "[2000,45,9E+09,9E+09,9E+09,9E+09]"


def test_they_are_on_the_way_in_proportion() -> None:
    robot = ArmRobot(arm_named("irb120"), external=AXES)
    declarations = """VAR intnum i; VAR clock c;
    TRAP look
      VAR pos at;
      at := CPos(); TPWrite ""\\Num:=at.y; TPWrite ""\\Num:=track();
    ENDTRAP
    FUNC num track() VAR jointtarget j; j := CJointT(); RETURN j.extax.eax_a; ENDFUNC"""
    lines = (
        f"{START} CONNECT i WITH look; ITimer \\Single, 1, i; MoveL {AT.format(100, 2000, '9E9')}, v1000, fine, tool0;"
    )
    outcome, (y, track) = run(lines, declarations, robot=robot)
    assert outcome.reason == "end"
    assert float(track) / 2000.0 == pytest.approx((float(y) + 100.0) / 200.0, abs=1e-3)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (f"MoveL {AT.format(100, 5000, '9E9')}, v100, fine, tool0;", "eax_a is 5000 mm, and ranges from 0 to 4000"),
        (f"MoveL {AT.format(-100, 50, '9E9')}, v100, fine, tool0;", "external axes alone does not run with an arm"),
    ],
)
def test_what_ends_a_program(lines: str, message: str) -> None:
    end, _, _ = on_track(lines)
    assert message in end
    assert "test.mod:" in end


def test_axes_that_the_arm_does_not_have_are_a_warning() -> None:
    robot = ArmRobot(arm_named("irb120"))
    lines = f"ConfL \\Off; ConfJ \\Off; MoveJ {AT.format(-100, 100, 0)}, v1000, fine, tool0;"
    run(lines, robot=robot)
    assert any("eax_a: the arm has no such external axis" in one for one in robot.planner.warnings)
    assert not any("eax_b" in one for one in robot.planner.warnings)


@pytest.mark.parametrize(
    "text", ["", "a", "g=linear,0,1,1", "a=round,0,1,1", "a=linear,1,0,1", "a=turn,0,1,0", "a=turn,0,nan,1"]
)
def test_texts_that_are_no_axis(text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    module = tmp_path / "m.mod"
    module.write_text("MODULE m\nPROC main()\nRETURN;\nENDPROC\nENDMODULE\n")
    assert main(["rapid", "run", str(module), "--robot", "irb120", "--external", text]) == 2
    assert "is no external axis" in capsys.readouterr().err
