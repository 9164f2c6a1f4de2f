import math

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.simulation.rendering.wide_lens import MAPPINGS, Mapping, WideLens

CLOSED_FORMS = {
    "gnomonical": math.tan,
    "stereographic": lambda angle: 2 * math.tan(angle / 2),
    "equidistant": lambda angle: angle,
    "equisolid_angle": lambda angle: 2 * math.sin(angle / 2),
    "orthographic": math.sin,
}


@pytest.mark.parametrize("kind", CLOSED_FORMS)
@given(half=st.floats(0.2, 1.35), share=st.floats(0.01, 1.0))
def test_angles_are_mapped_to_the_radii_of_the_closed_forms(kind, half, share):
    mapping, radius = MAPPINGS[kind].scaled(half), CLOSED_FORMS[kind](half * share) / CLOSED_FORMS[kind](half)
    assert float(mapping.radius(np.array(half * share))) == pytest.approx(radius)
    assert float(mapping.angle(np.array(radius))) == pytest.approx(half * share, abs=1e-6)


def test_a_custom_function_is_as_in_sdf():
    mapping = Mapping(c1=1.05, c2=4.0, c3=0.1, f=0.8, fun="tan")
    assert float(mapping.radius(np.array(1.2))) == pytest.approx(1.05 * 0.8 * math.tan(1.2 / 4 + 0.1))
    assert float(mapping.angle(mapping.radius(np.array(1.2)))) == pytest.approx(1.2)


@pytest.mark.parametrize(
    ("kind", "field", "sides"), [("equidistant", 2 * math.pi, 6), ("stereographic", 5.0, 6), ("gnomonical", 1.5, 1)]
)
def test_each_pixel_takes_its_ray_from_one_side_of_the_cube(kind, field, sides):
    lens = WideLens(61, 41, MAPPINGS[kind].scaled(field / 2), cutoff=math.pi, texture=64)
    found = np.full((61 * 41, 3), np.nan)
    for face in lens.faces:
        columns, rows = face.places[0].T
        assert columns.min() >= 0
        assert rows.min() >= 0
        assert columns.max() <= face.pinhole.width - 1
        assert rows.max() <= face.pinhole.height - 1
        x, y = (columns - face.pinhole.cx) / face.pinhole.fx, (rows - face.pinhole.cy) / face.pinhole.fy
        # x ahead, y left, z up.
        sensor = np.stack((np.ones_like(x), -x, -y), axis=1) @ face.pose.matrix[:3, :3].T
        assert np.isnan(found[face.pixels]).all()
        found[face.pixels] = np.stack((-sensor[:, 1], -sensor[:, 2], sensor[:, 0]), axis=1)
    found /= np.linalg.norm(found, axis=1, keepdims=True)
    rays = lens.rays.reshape(-1, 3)
    assert np.array_equal(np.isnan(found), np.isnan(rays))
    assert np.nanmax(np.abs(found - rays)) < 1e-5
    assert len(lens.faces) == sides


@pytest.mark.parametrize("kind", ["stereographic", "equidistant", "equisolid_angle", "orthographic"])
def test_opencv_projects_by_the_calibration_where_the_lens_does(kind):
    lens = WideLens(640, 480, MAPPINGS[kind].scaled(1.4), cutoff=1.4)
    model, distortion, matrix = lens.calibration
    assert model == "equidistant"
    rows, columns = np.nonzero(lens.rays[..., 2] > 0.05)
    rays = lens.rays[rows, columns]
    assert len(rays) > 100_000
    pixels, _ = cv2.fisheye.projectPoints(rays[:, None], np.zeros(3), np.zeros(3), matrix, np.array(distortion))
    assert np.abs(pixels[:, 0] - np.stack((columns, rows), axis=1)).max() < 0.6


def test_a_gnomonical_lens_is_a_pinhole_and_a_lens_that_no_model_describes_is_uncalibrated():
    model, distortion, matrix = WideLens(640, 480, MAPPINGS["gnomonical"].scaled(0.6)).calibration
    assert (model, distortion) == ("plumb_bob", (0.0,) * 5)
    assert matrix[0, 0] == pytest.approx(320 / math.tan(0.6))
    model, distortion, matrix = WideLens(640, 480, Mapping(c3=0.2, fun="id").scaled(1.0)).calibration
    assert (model, distortion, matrix.any()) == ("", (), False)
