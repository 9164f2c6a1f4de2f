"""Short reports of uncaught exceptions: the error after the lines of the user's own code that led to it."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType

VARIABLE = "DAIDALOS_TRACEBACK"
"""Environment variable; with the value ``full`` the frames of libraries are shown too."""

_OF_ROS1 = {
    "actionlib": "rclpy.action",
    "actionlib_msgs": "action_msgs",
    "dynamic_reconfigure": "parameters of rclpy's nodes",
    "move_base_msgs": "nav2_msgs",
    "nodelet": "rclcpp_components",
    "rosbag": "rosbag2_py",
    "roslaunch": "launch",
    "roslib": "ament_index_python",
    "rospkg": "ament_index_python",
    "rospy": "rclpy",
    "rostest": "launch_testing",
    "rostopic": "ros2topic",
    "tf": "tf2_ros",
}
"""Modules of ROS 1, and what stands for them today."""

_SOURCE = Path(__file__).resolve().parents[2]
_MORE = f"(set {VARIABLE}=full to see the whole traceback)"


def show(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Print an uncaught exception on standard error: the `sys.excepthook` of users' nodes."""
    text = "" if os.environ.get(VARIABLE) == "full" else report(error.with_traceback(trace))
    if text:
        sys.stderr.write(f"{text}\n")
    else:
        sys.__excepthook__(kind, error, trace)


def report(error: BaseException) -> str:
    """Return one line for each frame of the user's code, and then the error's own; empty without such a frame.

    Exceptions that led to this one come before it, as far as the user's code took part in them.
    """
    parts = [text for one in _chain(error) if (text := _one(one)) or one is error]
    return "\n".join([*parts, _MORE]) if parts[-1] else ""


def without_frames(text: str) -> str:
    """Return what a program printed with only the last line of each traceback in it."""
    lines, inside = [], False
    for line in text.splitlines():
        if line.startswith("Traceback (most recent call last)"):
            inside = True
        elif not inside or not line.startswith(" "):
            inside = False
            lines.append(line)
    chained = ("During handling of the above exception", "The above exception was the direct cause")
    first = next((number for number in reversed(range(len(lines))) if lines[number].startswith(chained)), -1)
    return "\n".join(lines[first + 1 :]).strip()


def own_frames(error: BaseException) -> list[tuple[str, int, str, str]]:
    """Return the frames in code that neither Python nor an installed library brings: (file, line, function, text)."""
    import traceback

    frames = traceback.extract_tb(error.__traceback__)
    return [(one.filename, one.lineno or 0, one.name, one.line or "") for one in frames if _is_own(one.filename)]


def _chain(error: BaseException) -> Iterator[BaseException]:
    """Yield the exceptions that led to one, the first of them first, and then the exception itself."""
    cause = error.__cause__ or (None if error.__suppress_context__ else error.__context__)
    if cause is not None:
        yield from _chain(cause)
    yield error


def _one(error: BaseException) -> str:
    import traceback

    frames = [f"{file}:{line}: in {name}: {text}" for file, line, name, text in own_frames(error)]
    if not frames and not isinstance(error, SyntaxError):
        return ""
    return "\n".join([*frames, "".join(traceback.format_exception_only(error)).rstrip() + _hint(error)])


def _hint(error: BaseException) -> str:
    """Return the name that a missing module of ROS 1 has today, or near names of an unknown attribute or import.

    Python before 3.12 keeps the near names to its own traceback.
    """
    if isinstance(error, ModuleNotFoundError) and error.name in _OF_ROS1:
        return f". '{error.name}' belongs to ROS 1: use {_OF_ROS1[error.name]}"
    if sys.version_info >= (3, 12):
        return ""
    from daidalos.common.suggestions import near

    name, known = None, None
    if isinstance(error, AttributeError):
        name, known = error.name, error.obj
    elif isinstance(error, ImportError) and (found := re.match(r"cannot import name '(\w+)'", str(error))):
        name, known = found.group(1), sys.modules.get(error.name or "")
    names = near(name, dir(known)) if name and known is not None else []
    return f". Did you mean: {' or '.join(map(repr, names))}?" if names else ""


def _is_own(file: str) -> bool:
    """Return whether a file is the user's: a Python file outside of Python's folders and of ours."""
    import sysconfig

    if not file.endswith(".py"):  # code without a file, and the scripts that installers write
        return False
    folders = {Path(sysconfig.get_path(name)) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    path = Path(file).resolve()
    return not any(path.is_relative_to(folder) for folder in (*folders, _SOURCE))
