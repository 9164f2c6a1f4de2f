"""Predefined functions against closed forms, numpy and scipy."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from daidalos.industry.rapid import predefined
from daidalos.industry.rapid.runtime import poses
from daidalos.industry.rapid.runtime.registry import find_routine, routines
from daidalos.industry.rapid.runtime.values import number_text, text_of, value_of_text
from properties import examples

from .running import run, written

NUMBERS = st.floats(-1e6, 1e6).map(lambda value: round(value, 3))
VECTORS = st.lists(NUMBERS, min_size=3, max_size=3)
ANGLES = st.floats(-180, 180)


@st.composite
def quaternions(draw: st.DrawFn) -> list[float]:
    q = np.array(draw(st.lists(st.floats(-1, 1), min_size=4, max_size=4)))
    norm = float(np.linalg.norm(q))
    assume(norm > 0.1)
    return [float(one) for one in q / norm]


def rotation(q: list[float]) -> Rotation:
    return Rotation.from_quat([q[1], q[2], q[3], q[0]])


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("Abs(-2.5)", "2.5"),
        ("Sin(30)", "0.5"),
        ("Cos(60)", "0.5"),
        ("Tan(45)", "1"),
        ("ASin(0.5)", "30"),
        ("ACos(0.5)", "60"),
        ("ATan(1)", "45"),
        ("ATan2(1, -1)", "135"),
        ("Sqrt(2)", "1.41421"),
        ("Exp(1)", "2.71828"),
        ("Pow(2, 10)", "1024"),
        ("Round(2.5)", "3"),
        ("Round(-2.5)", "-3"),
        ("Round(1.2345 \\Dec:=2)", "1.23"),
        ("Trunc(-2.7)", "-2"),
        ("Trunc(1.239 \\Dec:=2)", "1.23"),
        ("Max(1, 2)", "2"),
        ("Min(1, 2)", "1"),
        ("BitAnd(12, 10)", "8"),
        ("BitOr(12, 10)", "14"),
        ("BitXOr(12, 10)", "6"),
        ("BitNeg(0)", "255"),
        ("BitLSh(129, 1)", "2"),
        ("BitRSh(129, 1)", "64"),
        ('StrLen("abc")', "3"),
        ('StrFind("Robotics", 1, "aeiou")', "2"),
        ('StrFind("aaab", 1, "a" \\NotInSet)', "4"),
        ('StrFind("abc", 1, "x")', "4"),
        ('StrMatch("Robotics", 1, "bo")', "3"),
        ('StrMatch("Robotics", 1, "x")', "9"),
        ('StrToByte("10")', "10"),
        ('StrToByte("AE" \\Hex)', "174"),
        ('StrToByte("176" \\Okt)', "126"),
        ('StrToByte("10101110" \\Bin)', "174"),
        ('StrToByte("A" \\Char)', "65"),
        ("Distance([1,1,1],[4,5,1])", "5"),
        ("VectMagn([3,4,12])", "13"),
        ("DotProd([1,2,3],[4,5,6])", "32"),
        ("EulerZYX(\\Z, OrientZYX(30, 20, 10))", "30"),
        ("EulerZYX(\\X, OrientZYX(30, 20, 10))", "10"),
    ],
)
def test_numbers(expression: str, value: str) -> None:
    assert written(f'TPWrite "" \\Num:={expression};') == [value]


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ('StrPart("Robotics", 1, 5)', "Robot"),
        ("NumToStr(0.38521, 3)", "0.385"),
        ("NumToStr(0.38521, 2 \\Exp)", "3.85E-01"),
        ("ValToStr(1.5)", "1.5"),
        ('ValToStr("a""b")', '"a""b"'),
        ("ValToStr([1,-0.25,1E10])", "[1,-0.25,1E+10]"),
        ("ValToStr(TRUE)", "TRUE"),
        ('StrMap("Robotics", "aeiou", "AEIOU")', "RObOtIcs"),
        ("ByteToStr(122)", "122"),
        ("ByteToStr(122 \\Hex)", "7A"),
        ("ByteToStr(122 \\Okt)", "172"),
        ("ByteToStr(122 \\Bin)", "01111010"),
        ("ByteToStr(122 \\Char)", "z"),
        ('DecToHex("99999999")', "5F5E0FF"),
        ('HexToDec("5F5E0FF")', "99999999"),
        ('StrDigCalc("9999999999", OpAdd, "1")', "10000000000"),
        ('StrFormat("{2}-{1}" \\Arg1:="a" \\Arg2:="b")', "b-a"),
        ("CDate()", "2000-01-01"),
        ("Type(tool0)", "tooldata"),
    ],
)
def test_strings(expression: str, value: str) -> None:
    assert written(f"TPWrite {expression};") == [value]


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ('StrMemb("Robotics", 2, "aeiou")', "TRUE"),
        ('StrOrder("FIRST", "SECOND", STR_UPPER)', "TRUE"),
        ('StrOrder("FIRSTB", "FIRST", STR_UPPER)', "FALSE"),
        ("BitCheck(130, 8)", "TRUE"),
        ("BitCheck(130, 1)", "FALSE"),
        ('StrDigCmp("10", GT, "9")', "TRUE"),
        ("tool0.tframe.trans = [0,0,0]", "TRUE"),
        ('"a" = "A"', "FALSE"),
        ("IsPers(tool0)", "TRUE"),
    ],
)
def test_truth_values(expression: str, value: str) -> None:
    assert written(f'TPWrite "" \\Bool:={expression};') == [value]


def test_text_to_value() -> None:
    lines = """VAR num n; VAR pos p; VAR bool b; VAR string s;
    TPWrite "" \\Bool:=StrToVal("3.85", n); TPWrite "" \\Num:=n;
    TPWrite "" \\Bool:=StrToVal("[600,500,225.3]", p); TPWrite "" \\Pos:=p; TPWrite "" \\Bool:=StrToVal("[1,2]", p);
    TPWrite "" \\Bool:=StrToVal("TRUE", b) AND b; TPWrite "" \\Bool:=StrToVal("x y", s); TPWrite s;"""
    assert written(lines) == ["TRUE", "3.85", "TRUE", "[600,500,225.3]", "FALSE", "TRUE", "TRUE", "x y"]


def test_raw_bytes() -> None:
    lines = """VAR rawbytes r; VAR num n; VAR string s;
    PackRawBytes 258, r, 1 \\IntX:=UINT; PackRawBytes 1.5, r, 3 \\Float4;
    PackRawBytes "abc", r, RawBytesLen(r) + 1 \\ASCII; UnpackRawBytes r \\Network, 1, n \\IntX:=UINT;
    TPWrite "" \\Num:=n;
    UnpackRawBytes r, 3, n \\Float4; TPWrite "" \\Num:=n; UnpackRawBytes r, 7, s \\ASCII:=3; TPWrite s;"""
    assert written(lines) == ["513", "1.5", "abc"]


@examples(200)
@given(quaternions(), quaternions(), VECTORS, VECTORS)
def test_poses_multiply_and_invert(a: list[float], b: list[float], u: list[float], v: list[float]) -> None:
    product = poses.pose_product([u, a], [v, b])
    np.testing.assert_allclose(product[0], np.array(u) + rotation(a).apply(v), atol=1e-5)
    np.testing.assert_allclose(rotation(product[1]).as_matrix(), (rotation(a) * rotation(b)).as_matrix(), atol=1e-9)
    back = poses.pose_product(poses.pose_inverse([u, a]), [u, a])
    np.testing.assert_allclose(back[0], 0, atol=1e-5)
    assert poses.angle_between(back[1], [1, 0, 0, 0]) < 1e-4


@examples(200)
@given(ANGLES, st.floats(-89, 89), ANGLES)
def test_angles_of_orientations(z: float, y: float, x: float) -> None:
    q = poses.orientation_from_zyx(z, y, x)
    expected = Rotation.from_euler("ZYX", [z, y, x], degrees=True)
    np.testing.assert_allclose(rotation(q).as_matrix(), expected.as_matrix(), atol=1e-12)
    again = poses.orientation_from_zyx(*poses.euler_zyx(q))
    assert poses.angle_between(q, again) < 1e-4


@examples(100)
@given(quaternions())
def test_orientation_of_axes(q: list[float]) -> None:
    axes = [poses.rotate(q, axis) for axis in ([1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0])]
    assert poses.angle_between(q, poses.quaternion_of_axes(*axes)) < 1e-4


def test_frames_of_points() -> None:
    frame = poses.frame_of_points([1.0, 2.0, 3.0], [1.0, 5.0, 3.0], [-4.0, 2.5, 3.0])
    assert frame[0] == [1.0, 2.0, 3.0]
    np.testing.assert_allclose(poses.rotate(frame[1], [1, 0, 0]), [0, 1, 0], atol=1e-12)
    np.testing.assert_allclose(poses.rotate(frame[1], [0, 1, 0]), [-1, 0, 0], atol=1e-12)
    outcome, _ = run("VAR robtarget p; p.rot := [1,0,0,0]; TPWrite ValToStr(DefFrame(p, p, p));")
    assert "ERR_FRAME" in outcome.message


def test_an_orientation_that_is_none() -> None:
    outcome, _ = run("VAR robtarget p; MoveL p, v100, fine, tool0;")
    assert "ERR_ILLQUAT: the orientation has the length 0" in outcome.message


def test_mirroring_twice_is_nothing() -> None:
    lines = """VAR robtarget p := [[1,2,3],[0.9,0.3,0.3,0.1],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]; VAR robtarget q;
    p.rot := NOrient([0.5,0.5,0.5,0.5]); q := MirPos(p, wobj0); TPWrite ValToStr(q.trans);
    q := MirPos(q, wobj0); TPWrite ValToStr(q.trans); TPWrite ValToStr(q.rot);"""
    assert written(lines) == ["[1,2,-3]", "[1,2,3]", "[0.5,0.5,0.5,0.5]"]


_EXPRESSIONS = st.recursive(
    st.integers(-9, 9).map(lambda n: f"({n})" if n < 0 else str(n)),
    lambda inner: (
        st.tuples(inner, st.sampled_from("+-*"), inner).map(lambda parts: f"({' '.join(parts)})")
        | st.tuples(inner, st.sampled_from("+-*"), inner).map(" ".join)
    ),
    max_leaves=12,
)


@examples(200)
@given(_EXPRESSIONS)
def test_arithmetic_is_that_of_python(expression: str) -> None:
    assert written(f'TPWrite "" \\Num:={expression};') == [number_text(float(eval(expression)))]


@examples(200)
@given(
    st.recursive(
        NUMBERS | st.booleans() | st.text('ab"\\ ', max_size=4), lambda inner: st.lists(inner, min_size=1, max_size=4)
    )
)
def test_text_of_a_value_is_read_back(value: object) -> None:
    again = value_of_text(text_of(value, 17), value)
    assert again == value


def test_every_routine_that_runs_is_declared() -> None:
    for name in routines():
        assert predefined.find(name) is not None, name
    assert math.isclose(find_routine("sin")(None, angle_=90.0), 1.0)  # type: ignore[misc]
