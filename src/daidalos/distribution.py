"""Distribution of ROS 2 that this package implements."""

from __future__ import annotations

import os
import sys
from pathlib import Path

DISTRIBUTION = "jazzy"

ENVIRONMENT = {"ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3", "ROS_DISTRO": DISTRIBUTION}
"""What the setup file of a ROS 2 that is installed sets, and launch files, programs and manifests ask for."""


def complete_environment() -> None:
    """Set what is not set in this process's environment, for it and for those that it starts."""
    for name, value in ENVIRONMENT.items():
        os.environ.setdefault(name, value)


def complete_prefix_path() -> None:
    """Set ``AMENT_PREFIX_PATH`` to the Python environment and the built-in packages if it is not set."""
    if not os.environ.get("AMENT_PREFIX_PATH"):
        os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join((sys.prefix, str(Path(__file__).parent)))
