"""Calibration files, in YAML, and their URLs."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

from sensor_msgs.msg import CameraInfo

from daidalos.common.documents import read_yaml

DEFAULT_URL = "file://${ROS_HOME}/camera_info/${NAME}.yaml"
"""Where calibrations are unless another place is given."""

_MATRICES = (
    ("camera_matrix", "k", 3, 3),
    ("distortion_coefficients", "d", 1, 0),
    ("rectification_matrix", "r", 3, 3),
    ("projection_matrix", "p", 3, 4),
)


def genCameraName(from_string: str) -> str:
    """Return a camera name: characters other than letters, digits and underscores become underscores."""
    return re.sub(r"[^a-zA-Z0-9_]", "_", from_string)


def resolveURL(url: str, cname: str) -> str:
    """Return a URL with ``${NAME}`` and ``${ROS_HOME}`` replaced."""
    home = os.environ.get("ROS_HOME") or str(Path.home() / ".ros")
    return url.replace("${NAME}", cname).replace("${ROS_HOME}", home)


def path_of(url: str, cname: str) -> Path:
    """Return the file of a URL; empty: that of `DEFAULT_URL`.

    Raises
    ------
    ValueError
        When it is neither ``file://`` with an absolute path nor ``package://`` with a known package.
    """
    from ament_index_python.packages import PackageNotFoundError, get_package_share_path

    resolved = resolveURL(url or DEFAULT_URL, cname)
    if resolved.lower().startswith("file:///"):
        return Path(resolved[len("file://") :])
    match = re.fullmatch(r"package://([^/]+)/(.+)", resolved)
    if match is None:
        raise ValueError(f"'{resolved}' is not a URL of a calibration, such as file:///path or package://name/path")
    try:
        return get_package_share_path(match[1]) / match[2]
    except PackageNotFoundError as error:
        raise ValueError(f"'{resolved}': {error}") from None


def loadCalibrationFile(filename: str | Path, cname: str) -> CameraInfo | None:
    """Return the calibration of a file; None where there is no file.

    Raises
    ------
    ValueError
        When the file is no calibration; names the file and the line or field.
    """
    path = Path(filename)
    try:
        content = read_yaml(path)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise ValueError(f"{path}: {error.strerror}") from None
    if not isinstance(content, dict):
        raise ValueError(f"{path}: expected a mapping")
    info = CameraInfo()
    try:
        info.width, info.height = int(content["image_width"]), int(content["image_height"])
        info.distortion_model = str(content["distortion_model"])
        for name, attribute, rows, columns in _MATRICES:
            data = [float(one) for one in content[name]["data"]]
            if columns and len(data) != rows * columns:
                raise ValueError(f"{name}: expected {rows * columns} numbers, found {len(data)}")
            setattr(info, attribute, data)
    except KeyError as error:
        raise ValueError(f"{path}: {error} is missing") from None
    except (AssertionError, OverflowError, TypeError, ValueError) as error:
        raise ValueError(f"{path}: {error}") from None
    return info


def saveCalibrationFile(ci: CameraInfo, filename: str | Path, cname: str) -> bool:
    """Write a calibration to a file, atomically; return whether that was possible."""
    import yaml

    content: dict[str, Any] = {
        "image_width": ci.width,
        "image_height": ci.height,
        "camera_name": cname,
        "distortion_model": ci.distortion_model,
    }
    for name, attribute, rows, columns in _MATRICES:
        data = [float(one) for one in getattr(ci, attribute)]
        content[name] = {"rows": rows, "cols": columns or len(data), "data": data}
    path = Path(filename)
    draft = path.with_name(f".{path.name}.new")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        draft.write_text(yaml.safe_dump(content, sort_keys=False, default_flow_style=None), encoding="utf-8")
        draft.replace(path)
    except OSError:
        return False
    return True
