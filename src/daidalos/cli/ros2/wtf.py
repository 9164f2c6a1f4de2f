"""`ros2 wtf`."""

from __future__ import annotations

from daidalos.cli.ros2.doctor import DoctorCommand


class WtfCommand(DoctorCommand):
    """Use `wtf` as alias to `doctor`."""

    module = DoctorCommand.__module__
