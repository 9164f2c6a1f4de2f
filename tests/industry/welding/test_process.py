"""Process models: power laws of the wrench, fitted and applied, and seams with feeds of their own."""

import re

import numpy as np
import pytest

from daidalos.common.documents import DocumentError
from daidalos.common.errors import UserError
from daidalos.industry.welding.planning import Request, plan
from daidalos.industry.welding.process import FSW, process_model, read_process
from daidalos.industry.welding.reading import read_seam
from daidalos.industry.welding.results import write_plan

from .cells import cell

HEAD = "feed_mm_min,spindle_rpm,fx,fy,fz,mx,my,mz"


def weld(feed, spindle, noise=1.0):
    fx, fz = 400.0 * (feed / 300.0) ** 0.6 * (spindle / 800.0) ** -0.4, 8000.0 * (spindle / 800.0) ** -0.3
    return f"{feed},{spindle},{fx * noise},{-0.4 * fx},{fz},0,0,7"


def test_built_in_model_has_the_workshops_wrench():
    found = process_model("fsw").wrenches(np.array([0.005]), np.array([800.0 / 60.0]))
    np.testing.assert_allclose(found, [[420.0, -175.0, 8000.0, 0.0, 0.0, 7.0]])


def test_forces_rise_with_the_feed_and_fall_with_the_spindle_speed():
    slow, fast, hot = FSW.wrenches(np.array([0.0025, 0.01, 0.0025]), np.array([10.0, 10.0, 30.0]))
    assert (np.abs(fast[:3]) > np.abs(slow[:3])).all()
    assert (np.abs(hot[:3]) < np.abs(slow[:3])).all()


def test_measured_welds_give_their_exponents(tmp_path):
    path = tmp_path / "welds.csv"
    path.write_text("\n".join([HEAD, *(weld(feed, spindle) for feed in (150, 300, 600) for spindle in (600, 1000))]))
    found = read_process(path)
    np.testing.assert_allclose(found.feed_exponents, [0.6, 0.6, 0, 0, 0, 0], atol=1e-9)
    np.testing.assert_allclose(found.spindle_exponents, [-0.4, -0.4, -0.3, 0, 0, 0], atol=1e-9)
    np.testing.assert_allclose(found.residuals, 0.0, atol=1e-9)
    wrench = found.wrenches(np.array([0.005]), np.array([800.0 / 60.0]))[0]
    np.testing.assert_allclose(wrench, [400.0, -160.0, 8000.0, 0.0, 0.0, 7.0], rtol=1e-9)


def test_residuals_tell_what_the_law_does_not(tmp_path):
    path = tmp_path / "welds.csv"
    rows = [weld(f, n, 1.05 if (f > 200) ^ (n > 800) else 0.95) for f in (150, 600) for n in (600, 1000)]
    path.write_text("\n".join([HEAD, *rows]))
    assert read_process(path).residuals[0] == pytest.approx(0.05, rel=0.05)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([weld(300, 800)], "has 1 welds; at least three are needed"),
        ([weld(feed, 800) for feed in (100, 200, 300)], "with feed and spindle speed varied independently"),
        ([weld(100 * k, 200 * k) for k in (1, 2, 3)], "with feed and spindle speed varied independently"),
        ([weld(100, 600), weld(0, 700), weld(300, 900)], ":3: feed_mm_min is 0, but must be greater than 0"),
        (
            [weld(100, 600), weld(200, 900), "300,700,-1,-1,1,0,0,1"],
            ":4: fx is -1, but must have the same sign in all welds",
        ),
        (["1,2,3"], ":2: has 3 values, but 8 are expected"),
    ],
)
def test_welds_that_give_no_model_are_refused(rows, message, tmp_path):
    path = tmp_path / "welds.csv"
    path.write_text("\n".join([HEAD, *rows]))
    with pytest.raises(DocumentError, match=re.escape(message)) as error:
        read_process(path)
    assert "welds.csv" in str(error.value)


def test_unknown_models_and_other_regions_are_refused():
    with pytest.raises(UserError, match="fws: there is no such file, and no process model of this name but 'fsw'"):
        process_model("fws")
    with pytest.raises(
        UserError, match="point 2: the feed is 6000 mm/min, but the process model 'fsw' holds for 50 to"
    ):
        FSW.wrenches(np.array([0.005, 0.1]), np.array([10.0, 10.0]))
    with pytest.raises(UserError, match="point 1: the spindle speed is 60 1/min"):
        FSW.wrenches(np.array([0.005]), np.array([1.0]))


def test_feeds_of_a_seam_give_wrenches_and_speeds_point_by_point(tmp_path):
    path = tmp_path / "seam.csv"
    path.write_text(
        "x_mm,y_mm,z_mm,feed_mm_min,spindle_rpm\n2300,200,900,300,800\n2300,0,900,300,800\n2300,-200,900,600,800\n"
    )
    done = plan(cell(), read_seam(path), Request(speed=1.0, wrench=None, process=FSW, points=9))
    np.testing.assert_allclose(60e3 * done.speeds, [300] * 5 + [375, 450, 525, 600])
    assert done.wrenches[0, 2] == pytest.approx(8000.0)
    assert done.wrenches[-1, 2] == pytest.approx(8000.0 * 2.0**0.2)
    # The axial deflection follows the force.
    assert abs(done.before[-1, 2]) > 1.05 * abs(done.before[4, 2])
    assert np.abs(done.after).max() < 1e-6
    write_plan(done, tmp_path / "out", "seam", 120.0)
    krl = (tmp_path / "out" / "weld_seam.src").read_text()
    assert re.findall(r"VEL\.CP=([\d.]+)", krl) == ["0.005000", "0.006250", "0.007500", "0.008750", "0.010000"]
    rapid = (tmp_path / "out" / "weld_seam.mod").read_text()
    assert rapid.count("CONST speeddata") == 5
    assert rapid.count(",vWeld,z0,") == 5


def test_feeds_that_are_not_positive_are_refused(tmp_path):
    path = tmp_path / "seam.csv"
    path.write_text("x_mm,y_mm,z_mm,feed_mm_min\n2300,200,900,300\n2300,0,900,-1\n")
    with pytest.raises(DocumentError, match=r"seam.csv:3: feed_mm_min is -1, but must be greater than 0"):
        read_seam(path)
