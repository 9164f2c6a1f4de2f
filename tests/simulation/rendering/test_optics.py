import cv2
import numpy as np
import pytest

from daidalos.simulation.rendering.optics import OPTICAL, Pinhole

BENT = Pinhole(64, 48, 60.0, 62.0, 31.0, 24.5, (-0.2, 0.05, 0.001, -0.002, 0.01))


def test_the_field_of_view_gives_the_focal_length():
    pinhole = Pinhole.from_field_of_view(640, 480, 2 * np.arctan(1.0))
    assert (pinhole.fx, pinhole.fy) == pytest.approx((320, 320))
    assert (pinhole.cx, pinhole.cy) == (320, 240)


def test_the_optical_frame_looks_along_z_with_x_to_the_right():
    assert OPTICAL.transform((0, 0, 1)) == pytest.approx((1, 0, 0), abs=1e-12)
    assert OPTICAL.transform((1, 0, 0)) == pytest.approx((0, -1, 0), abs=1e-12)
    assert OPTICAL.transform((0, 1, 0)) == pytest.approx((0, 0, -1), abs=1e-12)


def test_points_fall_where_opencv_says():
    points = np.random.default_rng(1).uniform((-0.4, -0.3, 1.0), (0.4, 0.3, 3.0), (50, 3))
    theirs = cv2.projectPoints(points, np.zeros(3), np.zeros(3), BENT.matrix, np.array(BENT.distortion))[0]
    assert BENT.project(points) == pytest.approx(theirs.reshape(-1, 2), abs=1e-9)


def test_rays_lead_back_to_their_pixels():
    rays = BENT.rays.reshape(-1, 3).astype(float)
    columns, rows = np.meshgrid(np.arange(64), np.arange(48))
    assert BENT.project(rays) == pytest.approx(np.stack((columns.ravel(), rows.ravel()), axis=1), abs=1e-3)


def test_the_ideal_camera_holds_every_pixel():
    lookup, ideal = BENT.lookup, BENT.ideal
    assert lookup[..., 0].min() >= 0
    assert lookup[..., 0].max() <= ideal.width - 1
    assert lookup[..., 1].min() >= 0
    assert lookup[..., 1].max() <= ideal.height - 1
