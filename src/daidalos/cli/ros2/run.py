"""`ros2 run`."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from argparse import REMAINDER, ArgumentParser, Namespace

from daidalos.cli.ros2.completion import complete_executables, complete_packages
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Command, Status
from daidalos.common.suggestions import did_you_mean


class RunCommand(Command):
    """Run a package specific executable."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        parser.add_argument(
            "--prefix",
            help="Prefix command, which should go before the executable. Command must be wrapped in quotes if it "
            "contains spaces (e.g. --prefix 'gdb -ex run --args').",
        )
        complete_packages(parser.add_argument("package_name", help="Name of the ROS package"))
        complete_executables(parser.add_argument("executable_name", help="Name of the executable"))
        parser.add_argument("argv", nargs=REMAINDER, help="Pass arbitrary arguments to the executable")

    def main(self, *, parser: ArgumentParser, args: Namespace) -> Status:
        """Replace this process by the executable, which gets its signals, its terminal and its exit status."""
        from daidalos.workspaces.executables import interrupts_blocked, reporting_command

        command = [*shlex.split(args.prefix or ""), *_find(args.package_name, args.executable_name), *args.argv]
        command = reporting_command(command)
        sys.stdout.flush()
        if sys.platform == "win32":
            return subprocess.run(command, check=False).returncode
        try:
            with interrupts_blocked(command):
                os.execvp(command[0], command)
        except OSError as error:
            raise CliError(f"{command[0]}: {error.strerror}") from None


def _find(package: str, executable: str) -> list[str]:
    from daidalos.cli.ros2.packages import package_names
    from daidalos.cli.ros2.workspace_hints import unknown_executable, unknown_package
    from daidalos.workspaces.executables import ExecutableNotFound, executables, find_executable, is_known, left_out

    try:
        return find_executable(package, executable)
    except ExecutableNotFound:
        if is_known(package):
            reason = left_out(package, executable)
            if reason:
                raise CliError(f"No executable found: {reason}") from None
            hint = did_you_mean(executable, executables(package)) or unknown_executable(package, executable)
            raise CliError(f"No executable found{hint}") from None
        hint = unknown_package(package) or did_you_mean(package, package_names())
        raise CliError(f"Package '{package}' not found{hint}") from None
