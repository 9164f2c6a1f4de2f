"""Cameras from their calibration, beside OpenCV and closed forms."""

import math

import cv2
import numpy as np
import pytest
from image_geometry import PinholeCameraModel, StereoCameraModel
from sensor_msgs.msg import CameraInfo

from daidalos.simulation.rendering.optics import Pinhole

K = np.array(((430.0, 0.0, 308.0), (0.0, 431.0, 230.0), (0.0, 0.0, 1.0)))
MODELS = {
    "none": ("plumb_bob", []),
    "plumb bob": ("plumb_bob", [-0.36, 0.16, 0.001, -0.0007, -0.03]),
    "four": ("plumb_bob", [-0.36, 0.16, 0.001, -0.0007]),
    "rational": ("rational_polynomial", [0.6, 0.05, 0.001, -0.0005, 0.01, 1.0, 0.2, 0.02]),
    "thin prism": ("rational_polynomial", [-0.2, 0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.004, -0.001, 0.003, 0.001]),
    "fisheye": ("equidistant", [-0.02, 0.006, -0.004, 0.0008]),
}
PIXELS = np.array([(u, v) for u in (20.0, 200.0, 308.0, 500.0, 620.0) for v in (15.0, 230.0, 470.0)])


def info(name="plumb bob", rotation=(0.01, -0.02, 0.005), **changes):
    model, coefficients = MODELS[name]
    message = CameraInfo(width=640, height=480, distortion_model=model, d=coefficients, k=K.ravel().tolist())
    message.r = cv2.Rodrigues(np.array(rotation))[0].ravel().tolist()
    message.p = [400.0, 0.0, 320.0, 0.0, 0.0, 402.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    message.header.frame_id = "camera_optical"
    for key, value in changes.items():
        setattr(message, key, value)
    return message


def camera(*arguments, **changes):
    model = PinholeCameraModel()
    model.fromCameraInfo(info(*arguments, **changes))
    return model


@pytest.mark.parametrize("name", MODELS)
def test_points_are_rectified_as_opencv_does_it(name):
    model = camera(name)
    matrices = {"R": model.R, "P": model.P[:, :3]}
    if name == "fisheye":
        expected = cv2.fisheye.undistortPoints(PIXELS[:, None], K, model.D, **matrices)
    else:
        criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 300, 1e-12)
        expected = cv2.undistortPoints(PIXELS[:, None], K, model.D, **matrices, criteria=criteria)
    assert model.rectifyPoint(PIXELS) == pytest.approx(expected[:, 0], abs=2e-3)
    assert model.rectifyPoint(tuple(PIXELS[0])).shape == (2,)


@pytest.mark.parametrize("name", MODELS)
def test_unrectifying_undoes_it(name):
    model = camera(name)
    assert model.unrectify_point(model.rectify_point(PIXELS)) == pytest.approx(PIXELS, abs=1e-7)


def test_a_ray_through_the_lens_is_where_the_simulator_draws_it():
    model = camera(rotation=(0.0, 0.0, 0.0))
    points = np.array(((0.3, -0.2, 1.5), (-0.6, 0.4, 1.2), (0.0, 0.0, 2.0)))
    drawn = Pinhole(640, 480, *K[[0, 1, 0, 1], [0, 1, 2, 2]], distortion=tuple(MODELS["plumb bob"][1])).project(points)
    rectified = [model.project3dToPixel(point) for point in points]
    assert model.unrectifyPoint(rectified) == pytest.approx(drawn, abs=1e-9)


def test_pixels_and_points():
    model = camera()
    assert model.project3dToPixel((0.5, -0.25, 2.0)) == pytest.approx((320 + 100.0, 240 - 402 * 0.125))
    assert all(math.isnan(value) for value in model.project3dToPixel((1.0, 1.0, 0.0)))
    ray = model.projectPixelTo3dRay((420.0, 189.75))
    assert np.linalg.norm(ray) == pytest.approx(1.0)
    assert np.array(ray) / ray[2] == pytest.approx((0.25, -0.125, 1.0))
    assert model.getDeltaU(0.1, 2.0) == 20.0
    assert model.getDeltaY(model.getDeltaV(0.1, 2.0), 2.0) == pytest.approx(0.1)
    assert model.get_delta_x(20.0, 2.0) == pytest.approx(0.1)
    assert model.getDeltaV(0.1, 0.0) == math.inf


def test_what_a_camera_tells_of_itself():
    model = camera()
    assert (model.fx(), model.fy(), model.cx(), model.cy()) == (400.0, 402.0, 320.0, 240.0)
    assert (model.Tx(), model.ty()) == (0.0, 0.0)
    assert model.fovX() == pytest.approx(2 * math.atan(0.8))
    assert model.fov_y() == pytest.approx(2 * math.atan(240 / 402))
    assert (model.tfFrame(), model.tf_frame) == ("camera_optical", "camera_optical")
    assert model.fullResolution() == (640, 480)
    assert model.intrinsicMatrix() == pytest.approx(K)
    assert model.distortionCoeffs() == pytest.approx(MODELS["plumb bob"][1])
    assert model.rotationMatrix().shape == (3, 3)
    assert model.projectionMatrix().shape == (3, 4)


def test_a_region_of_interest_after_binning():
    message = info(binning_x=2, binning_y=4)
    message.roi.x_offset, message.roi.y_offset = 100, 40
    binned, full = PinholeCameraModel(), camera()
    binned.fromCameraInfo(message)
    point = (0.1, -0.3, 1.7)
    u, v = full.project3dToPixel(point)
    assert binned.project3dToPixel(point) == pytest.approx(((u - 100) / 2, (v - 40) / 4))
    raw = np.array((333.0, 77.0))
    expected = (full.rectifyPoint(raw) - (100, 40)) / (2, 4)
    assert binned.rectifyPoint((raw - (100, 40)) / (2, 4)) == pytest.approx(expected)
    assert binned.fullIntrinsicMatrix() == pytest.approx(K)
    assert binned.full_projection_matrix() == pytest.approx(full.P)
    assert binned.fovX() == full.fovX()


@pytest.mark.parametrize("shape", [(480, 640), (480, 640, 3)])
def test_an_image_is_rectified_as_opencv_does_it(shape):
    raw = np.random.default_rng(1).integers(0, 256, shape, dtype=np.uint8)
    raw = cv2.GaussianBlur(raw, (0, 0), 5.0)
    model, rectified = camera(), np.zeros_like(raw)
    model.rectifyImage(raw, rectified)
    maps = cv2.initUndistortRectifyMap(K, model.D, model.R, model.P[:, :3], (640, 480), cv2.CV_32FC2)
    expected = cv2.remap(raw, maps[0], None, cv2.INTER_CUBIC)
    assert np.abs(rectified.astype(int) - expected).max() <= 1


def test_an_image_without_distortion_needs_no_opencv(monkeypatch):
    monkeypatch.setattr("cv_bridge._opencv.opencv", lambda: None)
    raw = np.arange(480 * 640, dtype=np.uint16).reshape(480, 640)
    ideal = camera("none", rotation=(0.0, 0.0, 0.0), p=[*K[0], 0.0, *K[1], 0.0, *K[2], 0.0])
    rectified = np.zeros_like(raw)
    ideal.rectifyImage(raw, rectified)
    assert np.array_equal(raw, rectified)
    with pytest.raises(RuntimeError, match=r"OpenCV, which is not installed: pip install 'daidalos\[vision\]'"):
        camera().rectifyImage(raw, rectified)
    with pytest.raises(ValueError, match="has shape"):
        camera().rectifyImage(raw, rectified[1:])


def test_two_cameras():
    baseline, right_info = 0.12, info()
    right_info.p = [400.0, 0.0, 310.0, -400.0 * baseline, *right_info.p[4:]]
    pair = StereoCameraModel()
    pair.fromCameraInfo(info(), right_info)
    point = (0.4, -0.1, 2.5)
    left, right = pair.project3dToPixel(point)
    assert right == pytest.approx((310 + 400 * (0.4 - baseline) / 2.5, left[1]))
    assert pair.projectPixelTo3d(left, left[0] - right[0]) == pytest.approx(point)
    assert pair.projectPixelTo3d(left, 10.0) == (0.0, 0.0, 0.0)
    assert pair.getDisparity(2.5) == pytest.approx(400 * baseline / 2.5)
    assert pair.getZ(pair.getDisparity(2.5)) == pytest.approx(2.5)
    assert (pair.getZ(0.0), pair.get_disparity(0.0)) == (math.inf, math.inf)
    assert pair.tfFrame() == "camera_optical"
    assert pair.get_right_camera().Tx() == -400.0 * baseline
    with pytest.raises(ValueError, match="no distance from the left"):
        pair.fromCameraInfo(info(), info())


def test_cameras_that_are_none():
    with pytest.raises(ValueError, match="not calibrated"):
        PinholeCameraModel().fromCameraInfo(CameraInfo())
    with pytest.raises(ValueError, match="the distortion model 'jelly' with 5 coefficients is not one of 'plumb_bob'"):
        camera(distortion_model="jelly")
    with pytest.raises(ValueError, match="with 3 coefficients"):
        camera(d=[0.1, 0.2, 0.3])
