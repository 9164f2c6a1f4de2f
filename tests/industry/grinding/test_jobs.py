"""Passes over plates and clamps, their files, and workpieces from files."""

import io

import numpy as np
import pytest

from daidalos.common.documents import DocumentError
from daidalos.common.errors import UserError
from daidalos.industry.grinding.height_field import as_arrays, deviation, read_workpiece, scanned
from daidalos.industry.grinding.passes import even_passes, excess_passes, footprint, tools_along
from daidalos.industry.grinding.reach import flange_poses, joints_along
from daidalos.industry.grinding.records import read_record
from daidalos.industry.grinding.results import compared, write_job
from daidalos.industry.grinding.settings import CellParameters, read_cell
from daidalos.industry.grinding.tasks import clamp_job, make_controller, plate_job
from daidalos.industry.grinding.workpieces import clamp, plate

COARSE = 1e-3
PARAMETERS = CellParameters()


def pi():
    return make_controller("pi", {}, PARAMETERS)


@pytest.mark.slow
def test_plate_loses_an_even_layer():
    depth = 40e-6
    piece = plate(0.2, depth, resolution=COARSE)
    job = plate_job(piece, PARAMETERS, pi, 30.0, depth, 0.012).run("irb8700")
    assert not job.problem
    removed = job.depth_removed[job.begin.region]
    # Removal within 20 % of what was planned, everywhere.
    assert np.quantile(removed, 0.005) > 0.8 * depth
    assert np.quantile(removed, 0.995) < 1.2 * depth
    assert job.passes[0].removed == pytest.approx(job.passes[0].predicted, rel=0.2)


@pytest.mark.slow
def test_clamp_comes_within_its_tolerance_pass_by_pass(tmp_path):
    piece = clamp(0.6e-3, seed=1, resolution=COARSE)
    job = clamp_job(piece, PARAMETERS, pi, 30.0, 100e-6, seed=1).run("irb8700")
    assert not job.problem
    assert len(job.passes) >= 2
    begin, end = deviation(job.begin, job.tolerance), deviation(job.end, job.tolerance)
    assert end.within > 0.99
    assert end.excess_volume < 0.2 * begin.excess_volume
    for one in job.passes:
        if one.predicted > 1e-7:
            assert one.removed == pytest.approx(one.predicted, rel=0.2)
    files = write_job(job, tmp_path / "out")
    names = [file.name for file in files]
    assert names[:3] == ["figures.json", "report.html", "workpiece.npz"]
    again = read_workpiece(tmp_path / "out" / "workpiece.npz")
    np.testing.assert_array_equal(again.surface, job.end.surface)
    record = read_record(tmp_path / "out" / "pass_1.npz")
    np.testing.assert_array_equal(record.force, job.passes[0].record.force)
    page = (tmp_path / "out" / "report.html").read_text()
    assert page.count("<svg") == 5 * len(job.passes)
    assert page.count("<img") == 2
    assert "http" not in page.replace("http://www.w3.org/2000/svg", "")
    rows = compared(tmp_path / "out", tmp_path / "out" / "figures.json")
    assert all(one == two for _, one, two in rows)
    assert ("tolerance_um", 100.0, 100.0) in rows
    with pytest.raises(UserError, match="is there already"):
        write_job(job, tmp_path / "out")


def test_plan_of_a_finished_workpiece_is_empty():
    done = clamp(resolution=COARSE)
    done = done.with_surface(done.target + 1e-5)
    assert excess_passes(done, PARAMETERS, 1e-4, 30.0, 2.8e-11) == []


def test_plan_removes_the_volume_of_the_excess():
    piece = clamp(1e-3, resolution=COARSE)
    lines = excess_passes(piece, PARAMETERS, 1e-4, 30.0, 2.8e-11, share=0.5, max_depth=1.0)
    rate = footprint(PARAMETERS, COARSE, 30.0, 2.8e-11).volume_rate
    planned = rate * sum(line.duration for line in lines)
    assert planned == pytest.approx(0.5 * deviation(piece, 1e-4).excess_volume, rel=0.1)
    assert all(line.lean == (0.0, 1.0) for line in lines)


def test_even_plan_covers_the_region_with_the_layer():
    piece = plate(0.16, 50e-6, resolution=COARSE)
    lines = even_passes(piece, PARAMETERS, 50e-6, 30.0, 0.012, 2.8e-11)
    rate = footprint(PARAMETERS, COARSE, 30.0, 2.8e-11).volume_rate
    spacing = abs(lines[1].points[0, 1] - lines[0].points[0, 1])
    assert rate / (lines[0].feeds[0] * spacing) == pytest.approx(50e-6, rel=1e-6)
    with pytest.raises(UserError, match="needs a feed of"):
        even_passes(piece, PARAMETERS, 1e-6, 100.0, 0.012, 2.8e-11)


def test_a_thick_layer_is_several_layers():
    piece = plate(0.16, 2e-3, resolution=COARSE)
    lines = even_passes(piece, PARAMETERS, 2e-3, 30.0, 0.012, 2.8e-11)
    places = [line.points[0, 1] for line in lines]
    assert lines[0].feeds[0] >= 0.004
    assert len(lines) == 3 * len(set(places))


def test_scan_is_the_surface_with_its_noise():
    piece = plate(0.1, roughness=0.0, resolution=COARSE)
    seen = scanned(piece, 5e-6, np.random.default_rng(0))
    assert 1e-6 < seen.surface.std() < 5e-6
    assert (scanned(piece, 0.0, np.random.default_rng(0)).surface == piece.surface).all()


def test_flange_stands_on_the_normal_of_the_clamp():
    piece = clamp(resolution=COARSE)
    line = excess_passes(piece, PARAMETERS, 1e-4, 30.0, 2.8e-11)[1]
    tools = tools_along(line, piece, piece.surface, PARAMETERS, 0.06)
    poses = flange_poses(tools, piece)
    x = line.points[0, 0]
    normal = np.array([x, 0.0, np.sqrt(0.2**2 - x**2)]) / 0.2
    np.testing.assert_allclose(poses[0, :3, 2], -normal, atol=0.01)
    np.testing.assert_allclose(np.linalg.det(poses[:, :3, :3]), 1.0, atol=1e-12)
    assert joints_along("irb8700", [tools], piece)[0].shape == (len(tools), 6)
    piece.pose[0, 3] = 6.0
    with pytest.raises(UserError, match=r"line 1: .* can not follow the path: point 1 is out of reach"):
        joints_along("irb8700", [tools], piece)
    with pytest.raises(UserError, match="there is no arm 'irb870'; did you mean 'irb8700'"):
        joints_along("irb870", [tools], piece)


def write_arrays(path, **changes):
    content = as_arrays(plate(0.02, resolution=COARSE)) | changes
    np.savez(path, **{name: value for name, value in content.items() if value is not None})
    return path


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"target": None}, "has no array 'target'"),
        ({"target": np.zeros((3, 3))}, r"'target' has the shape \(3, 3\), but \(20, 20\) is expected"),
        ({"surface": np.full((20, 20), np.nan)}, "'surface' has values that are not finite numbers"),
        ({"surface": np.zeros(3)}, r"'surface' has the shape \(3,\)"),
        ({"region": np.zeros((20, 20))}, "'region' must hold booleans, at least one of them true"),
        ({"region": np.zeros((20, 20), bool)}, "'region' must hold booleans, at least one of them true"),
        (
            {"resolution": np.array(-1.0), "region": np.ones((20, 20), bool)},
            "'resolution' is -1, but must be greater than 0",
        ),
        ({"pose": np.eye(3)}, r"'pose' has the shape \(3, 3\)"),
        ({"surface": np.full((20, 20), "a")}, "'surface' has values that are not finite numbers"),
        ({"surface": np.full((20, 20), None, dtype=object)}, "is no workpiece"),
    ],
)
def test_broken_workpieces_are_refused(changes, message, tmp_path):
    path = write_arrays(tmp_path / "piece.npz", **changes)
    with pytest.raises(UserError, match=message) as error:
        read_workpiece(path)
    assert str(path) in str(error.value)


def test_files_that_are_no_workpieces_are_refused(tmp_path):
    path = tmp_path / "piece.npz"
    with pytest.raises(UserError, match="there is no such file"):
        read_workpiece(path)
    for content in (b"", b"PK\x03\x04broken", b"hello", record_of_nothing()):
        path.write_bytes(content)
        with pytest.raises(UserError, match=r"piece.npz: (is no workpiece|has no array)"):
            read_workpiece(path)
        with pytest.raises(UserError, match=r"piece.npz: (is no record|has no array|'time' is no row)"):
            read_record(path)


def record_of_nothing():
    stream = io.BytesIO()
    np.savez(stream, time=np.zeros((2, 2)))
    return stream.getvalue()


def test_workpiece_from_a_grid_of_points(tmp_path):
    path = tmp_path / "scan.csv"
    rows = [f"{x},{y},{0.1 * x},0" for y in (0, 2, 4) for x in (10, 12, 14, 16)]
    path.write_text("\n".join(["x_mm,y_mm,z_mm,target_mm", *rows[::-1]]))
    piece = read_workpiece(path)
    assert piece.surface.shape == (3, 4)
    assert piece.resolution == pytest.approx(2e-3)
    np.testing.assert_allclose(piece.excess[0], 1e-4 * np.array([10, 12, 14, 16]))
    path.write_text("\n".join(["x_mm,y_mm,z_mm,target_mm", *rows[1:]]))
    with pytest.raises(UserError, match="there is no point at x_mm 10, y_mm 0"):
        read_workpiece(path)
    path.write_text("\n".join(["x_mm,y_mm,z_mm,target_mm", *rows, rows[2]]))
    with pytest.raises(DocumentError, match=r"scan.csv:14: has the same x_mm and y_mm"):
        read_workpiece(path)
    path.write_text("x_mm,y_mm,z_mm\n1,2,3\n")
    with pytest.raises(DocumentError, match=r"scan.csv:1: has no column 'target_mm'"):
        read_workpiece(path)
    path.write_text("x_mm,y_mm,z_mm,target_mm\n1,2,3,x\n")
    with pytest.raises(DocumentError, match=r"scan.csv:2: column 4: 'x' is no finite number"):
        read_workpiece(path)


def test_parameters_of_the_cell_from_a_file(tmp_path):
    path = tmp_path / "cell.yaml"
    path.write_text("disc: {radius: 0.05}\ncontact:\n  law: hertz\n")
    found = read_cell(path)
    assert (found.disc.radius, found.contact.law, found.arm) == (0.05, "hertz", PARAMETERS.arm)
    for text, message in (
        ("disc: {radius: -1.0}", "'disc.radius' must be above 0"),
        ("disc: {radus: 0.1}", "disc.radus"),
        ("disc: {inner_radius: 0.2}", "inner_radius"),
        ("- 1", "must be a mapping"),
        ("actuator: {static_friction: 1.0}", "static_friction"),
    ):
        path.write_text(text)
        with pytest.raises(DocumentError, match=message) as error:
            read_cell(path)
        assert "cell.yaml" in str(error.value)


def test_results_that_are_none_are_not_compared(tmp_path):
    with pytest.raises(UserError, match=r"figures.json: there is no such file"):
        compared(tmp_path, tmp_path)
    (tmp_path / "figures.json").write_text("[1]")
    with pytest.raises(UserError, match="has no figures of grinding"):
        compared(tmp_path, tmp_path)
    (tmp_path / "figures.json").write_text('{"task": "plate"}')
    (tmp_path / "other.json").write_text('{"task": "clamp"}')
    with pytest.raises(UserError, match=r"is of the task 'clamp', but .* of 'plate'"):
        compared(tmp_path, tmp_path / "other.json")
