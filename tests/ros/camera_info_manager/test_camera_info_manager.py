"""Calibrations of cameras."""

import pytest
from camera_info_manager import (
    CameraInfoManager,
    CameraInfoMissingError,
    genCameraName,
    loadCalibrationFile,
    resolveURL,
)
from sensor_msgs.msg import CameraInfo
from sensor_msgs.srv import SetCameraInfo


def calibration():
    return CameraInfo(
        width=640,
        height=480,
        distortion_model="plumb_bob",
        d=[0.1, 0.2, 0.0, 0.0, 0.0],
        k=[500.0, 0.0, 320.0, 0.0, 500.0, 240.0, 0.0, 0.0, 1.0],
        r=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p=[500.0, 0.0, 320.0, 0.0, 0.0, 500.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    )


def test_a_calibration_is_written_and_read(node, tmp_path):
    url = f"file://{tmp_path}/cameras/${{NAME}}.yaml"
    manager = CameraInfoManager(node, "left", url)
    with pytest.raises(CameraInfoMissingError):
        manager.isCalibrated()
    manager.loadCameraInfo()
    assert not manager.isCalibrated()
    request = SetCameraInfo.Request(camera_info=calibration())
    assert manager.setCameraInfo(request, SetCameraInfo.Response()).success
    other = CameraInfoManager(node, "left", url, namespace="other")
    other.loadCameraInfo()
    assert other.isCalibrated()
    assert other.getCameraInfo() == calibration()


def test_faults_are_named(node, tmp_path):
    file = tmp_path / "c.yaml"
    file.write_text("image_width: 2\nimage_height: 1\ndistortion_model: x\ncamera_matrix: {data: [1]}")
    with pytest.raises(ValueError, match=r"c\.yaml: camera_matrix: expected 9 numbers, found 1"):
        loadCalibrationFile(file, "c")
    file.write_text("image_width: 2")
    with pytest.raises(ValueError, match="'image_height' is missing"):
        loadCalibrationFile(file, "c")
    manager = CameraInfoManager(node, url=f"file://{file}")
    manager.loadCameraInfo()
    assert not manager.isCalibrated()
    assert not manager.setURL("ftp://nowhere")
    assert not manager.setCameraName("a camera")
    assert manager.setCameraName(genCameraName("a camera"))
    assert manager.getCameraName() == "a_camera"


def test_names_in_urls(monkeypatch):
    monkeypatch.setenv("ROS_HOME", "/home/me/.ros")
    assert resolveURL("file://${ROS_HOME}/${NAME}.yaml", "left") == "file:///home/me/.ros/left.yaml"
