"""The command `ros2` as a function."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import entry_points


def main(*, script_name: str = "ros2", argv: Sequence[str] | None = None) -> int:
    """Run the installed command `ros2` and return its exit status.

    Parameters
    ----------
    script_name
        Of no use: the command is always called ``ros2``.
    argv
        The arguments; those of the process where None.
    """
    (program,) = entry_points(group="console_scripts", name="ros2")
    status: int = program.load()(None if argv is None else list(argv))
    return status
