"""Checks and reports of `ros2 doctor`, one module per subject."""

from __future__ import annotations

from importlib import import_module

from daidalos.cli.ros2.checkup.added import added_subjects
from daidalos.cli.ros2.checkup.subject import Subject

_MODULES = ("network", "package", "platform", "environment", "qos", "topic", "endpoints")


def subjects() -> list[Subject]:
    """Return the subjects, including those of other packages.

    They add checks by the group ``ros2doctor.checks`` and reports by ``ros2doctor.report``: classes as of ROS 2's
    own doctor.
    """
    built_in = (import_module(f"{__name__}.{name}").SUBJECT() for name in _MODULES)
    return [*built_in, *added_subjects()]
