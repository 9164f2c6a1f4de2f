"""`daidalos arm`: what is printed, and what is wrong with what was typed."""

import re

import pytest

from daidalos.cli.daidalos import main


def test_forward_and_inverse_are_each_other(capsys):
    assert main(["arm", "forward", "irb120", "--", "-10", "20", "30", "40", "-50", "60"]) == 0
    printed = capsys.readouterr().out
    numbers = re.findall(r"-?\d+(?:\.\d+)?", printed)
    assert numbers[7:] == ["-1", "0", "0", "1"]
    assert main(["arm", "inverse", "irb120", "--", *numbers[:7]]) == 0
    row = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("1 "))
    angles = [float(text) for text in row.split("[")[0].split()[1:]]
    assert angles == pytest.approx([-10, 20, 30, 40, -50, 60], abs=0.005)
    assert row.endswith("[-1, 0, 0, 1]")


def test_a_singularity_is_printed_once_with_its_name(capsys):
    assert main(["arm", "inverse", "irb120", "374", "0", "630", "0.707107", "0", "0.707107", "0"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line[0] for line in lines[1:]] == list("0234567")
    assert lines[1].split("]")[1].strip() == "wrist singularity"
    assert lines[2].endswith("axis 3 out of range")


def test_an_arm_is_shown(capsys):
    assert main(["arm", "list"]) == 0
    assert "irb6700    ABB IRB 6700-150/3.20" in capsys.readouterr().out
    assert main(["arm", "show", "irb120"]) == 0
    assert "axis 2   -110.0 to  110.0 deg,  250.0 deg/s" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["forward", "irb12", *"000000"], "there is no arm 'irb12'; did you mean 'irb120'"),
        (["inverse", "irb120", "0", "0", "0", *"1111"], "the quaternion has the length 2, but must have 1"),
        (["inverse", "irb120", "900", "0", "630", *"1000"], "the pose is out of reach of ABB IRB 120-3/0.6"),
        (["forward", "irb120", "nan", *"00000"], "'nan' is not finite"),
    ],
)
def test_what_is_wrong_is_one_line(arguments, message, capsys):
    try:
        status = main(["arm", *arguments])
    except SystemExit as end:
        status = end.code
    assert status != 0
    error = capsys.readouterr().err
    assert message in error
    assert "Traceback" not in error


def test_an_arm_with_seven_axes_is_shown_with_its_arm_angle(capsys):
    assert main(["arm", "forward", "irb14000", *["20"] * 7]) == 0
    assert capsys.readouterr().out.endswith("arm angle 6.857 deg\n")
    assert main(["arm", "inverse", "irb14000", "300", "100", "300", "0", "0", "1", "0", "--arm-angle", "60"]) == 0
    assert capsys.readouterr().out.splitlines()[1].split()[0] == "60.000"
    assert main(["arm", "show", "irb14000"]) == 0
    assert "order of the axes from the base: 1, 2, 7, 3, 4, 5, 6" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["forward", "irb14000", "1", "2"], "has 7 axes, not 2: axes 1 to 6, then axis 7"),
        (["forward", "irb120", "1", "2"], "ABB IRB 120-3/0.6 has 6 axes, not 2"),
        (["inverse", "irb14000", "900", "0", "0", "1", "0", "0", "0"], "no solution was found within the ranges"),
        (["inverse", "irb120", *"0001000", "--arm-angle", "1"], "--arm-angle goes with an arm that has seven axes"),
    ],
)
def test_what_is_wrong_with_seven_axes_is_one_line(arguments, message, capsys):
    assert main(["arm", *arguments]) != 0
    error = capsys.readouterr().err
    assert message in error
    assert len(error.splitlines()) == 1
