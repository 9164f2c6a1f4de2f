"""The folder of a launch's log files."""

from __future__ import annotations

import datetime
import os
import socket


def get_logging_directory() -> str:
    """Return the folder below which each launch makes its own: $ROS_LOG_DIR, $ROS_HOME/log or ~/.ros/log."""
    log_dir = os.environ.get("ROS_LOG_DIR")
    if not log_dir:
        ros_home = os.environ.get("ROS_HOME") or os.path.join("~", ".ros")
        log_dir = os.path.join(ros_home, "log")
    return os.path.normpath(os.path.expanduser(log_dir))


def create_log_dir(base: str) -> str:
    """Create the folder of this launch below `base` and return its path."""
    now = datetime.datetime.now().strftime("%Y-%m-%d-%H-%M-%S-%f")
    name = f"{now}-{socket.gethostname()}-{os.getpid()}"
    folder = os.path.join(base, name)
    number = 1
    while True:
        try:
            os.makedirs(folder)
            break
        except FileExistsError:
            number += 1
            folder = os.path.join(base, f"{name}-{number}")
    return folder


def link_latest(folder: str) -> bool:
    """Create the link `latest` to a launch's folder beside it, and return whether there is one."""
    link = os.path.join(os.path.dirname(folder), "latest")
    if os.path.lexists(link) and not os.path.islink(link):
        return False
    fresh = f"{link}-{os.getpid()}"
    # A convenience only: not every file system has links, and another launch may do the same right now.
    try:
        os.symlink(os.path.basename(folder), fresh, target_is_directory=True)
        os.replace(fresh, link)
    except OSError:
        return False
    return True
