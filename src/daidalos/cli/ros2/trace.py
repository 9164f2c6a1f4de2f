"""`ros2 trace`."""

from __future__ import annotations

from argparse import REMAINDER, ArgumentParser, Namespace

from daidalos.cli.ros2.extension import Command, Status


class TraceCommand(Command):
    """Trace ROS nodes to get information on their execution."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Accept all arguments."""
        parser.add_argument("arguments", nargs=REMAINDER, help="Arguments of ROS 2's own `ros2 trace`")

    def main(self, *, parser: ArgumentParser, args: Namespace) -> Status:
        """Print that tracing is not available."""
        return (
            "`ros2 trace` is not available: it needs LTTng and the tracepoints in ROS 2's C++ libraries. "
            "For Python nodes a profiler helps, e.g. `ros2 run --prefix 'py-spy record --' <package> <executable>`."
        )
