"""Distribution of ROS 2 that this package implements."""

from __future__ import annotations

import os

DISTRIBUTION = "jazzy"

ENVIRONMENT = {"ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3", "ROS_DISTRO": DISTRIBUTION}
"""What the setup file of a ROS 2 that is installed sets, and launch files, programs and manifests ask for."""


def complete_environment() -> None:
    """Set what is not set in this process's environment, for it and for those that it starts."""
    for name, value in ENVIRONMENT.items():
        os.environ.setdefault(name, value)
