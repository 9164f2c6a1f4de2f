"""The command `ros2` as a function."""

from __future__ import annotations

from collections.abc import Sequence


def main(*, script_name: str = "ros2", argv: Sequence[str] | None = None) -> int:
    """Run a command line; returns the exit status.

    Parameters
    ----------
    script_name
        Of no use: the command is always called ``ros2``.
    argv
        The arguments; those of the process where None.
    """
    from daidalos.cli.ros2 import main as run

    return run(None if argv is None else list(argv))
