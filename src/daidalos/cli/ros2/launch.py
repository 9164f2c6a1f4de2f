"""`ros2 launch`."""

from __future__ import annotations

import os
import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.cli.ros2.completion import complete
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Command, Status
from daidalos.common.suggestions import did_you_mean
from daidalos.lockstep import options

if TYPE_CHECKING:
    from launch import LaunchDescription
    from launch.launch_description_source import LaunchDescriptionSource

# Where ROS 2 ends with 1: what starts a launch can tell a mistake in the file from a launch that failed.
_FAULTY_FILE = 2
_ENDINGS = (
    ".launch.py",
    "_launch.py",
    ".launch.xml",
    "_launch.xml",
    ".launch.yaml",
    "_launch.yaml",
    ".launch.yml",
    ".launch",
)


class LaunchCommand(Command):
    """Run a launch file."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        parser.add_argument(
            "-n",
            "--noninteractive",
            action="store_true",
            help="Run the launch system non-interactively, with no terminal associated",
        )
        parser.add_argument(
            "-d",
            "--debug",
            action="store_true",
            help="Put the launch system in debug mode, provides more verbose output.",
        )
        shown = parser.add_mutually_exclusive_group()
        shown.add_argument(
            "-p",
            "--print",
            "--print-description",
            action="store_true",
            help="Print the launch description to the console without launching it.",
        )
        shown.add_argument(
            "-s",
            "--show-args",
            "--show-arguments",
            action="store_true",
            help="Show arguments that may be given to the launch file.",
        )
        parser.add_argument(
            "-a",
            "--show-all-subprocesses-output",
            action="store_true",
            help="Show all launched subprocesses' output by overriding their output configuration using the "
            "OVERRIDE_LAUNCH_PROCESS_OUTPUT envvar.",
        )
        parser.add_argument(
            "--launch-prefix",
            help="Prefix command, which should go before all executables. Command must be wrapped in quotes if it "
            "contains spaces (e.g. --launch-prefix 'xterm -e gdb -ex run --args').",
        )
        parser.add_argument(
            "--launch-prefix-filter",
            help="Regex pattern for filtering which executables the --launch-prefix is applied to by matching the "
            "executable name.",
        )
        options.add_arguments(parser)
        complete(
            parser.add_argument("package_name", help="Name of the ROS package which contains the launch file"),
            _complete_first,
        )
        complete(
            parser.add_argument("launch_file_name", nargs="?", help="Name of the launch file"),
            lambda parsed_args, **_: [file.name for file in launch_files(parsed_args.package_name)],
        )
        complete(
            parser.add_argument(
                "launch_arguments",
                nargs="*",
                help="Arguments to the launch file; '<name>:=<value>' (for duplicates, last one wins)",
            ),
            lambda prefix, parsed_args, **_: _complete_argument(prefix, parsed_args),
        )
        self._options = _options()
        for _, option in sorted(self._options.items()):
            option.add_arguments(parser, cli_name)

    def main(self, *, parser: ArgumentParser, args: Namespace) -> Status:
        """Launch, or print what would be launched."""
        options.check(args)
        if args.lockstep:
            from daidalos.lockstep.start import replace_process

            return replace_process(["ros2", *options.without_options(args.words)], options.Options.of(args))
        from ros2launch.api import arguments_text, launch_source, parse_launch_arguments

        from daidalos.nodes.asset_folders import record_named_files

        path, words = _file_and_arguments(args)
        arguments = parse_launch_arguments(words)
        if args.show_all_subprocesses_output:
            os.environ["OVERRIDE_LAUNCH_PROCESS_OUTPUT"] = "both"  # read when a launch file makes its actions
        source, description = _load(path)
        if args.show_args:
            print(arguments_text(description))
            return 0
        if args.print:
            from launch.launch_introspector import LaunchIntrospector

            print(LaunchIntrospector().format_launch_description(description))
            return 0
        _warn_of_misspelt(arguments, description)
        record_named_files([args.package_name, *words])
        return launch_source(
            source,
            words,
            noninteractive=args.noninteractive,
            args=args,
            option_extensions=self._options,
            debug=args.debug,
        )


def _options() -> dict[str, Any]:
    """Return the options of other packages by name."""
    from importlib.metadata import entry_points

    if not entry_points(group="ros2launch.option"):  # spares the import of launch
        return {}
    from ros2launch.option import get_option_extensions

    return get_option_extensions()


def _warn_of_misspelt(arguments: list[tuple[str, str]], description: LaunchDescription) -> None:
    """Print a hint about undeclared arguments whose name is similar to a declared one."""
    if not arguments:
        return
    declared = [argument.name for argument in description.get_launch_arguments()]
    for name, _ in arguments:
        hint = "" if name in declared else did_you_mean(name, declared)
        if hint:
            print(f"The launch file does not declare the argument '{name}'{hint}", file=sys.stderr, flush=True)


def _file_and_arguments(args: Namespace) -> tuple[Path, list[str]]:
    """Return the launch file and the arguments on the command line."""
    rest = list(args.launch_arguments)
    first, second = args.package_name, args.launch_file_name
    if os.path.isfile(first) or second is None or ":=" in second:
        words = rest if second is None else [second, *rest]
        if not os.path.isfile(first):
            raise CliError(_no_file(first), _FAULTY_FILE)
        return Path(first), words
    return find_launch_file(first, second), rest


def _no_file(name: str) -> str:
    from daidalos.cli.ros2.packages import package_names

    if name in package_names():
        there = ", ".join(file.name for file in launch_files(name)) or "none"
        return f"The package '{name}' needs the name of one of its launch files: {there}"
    return f"The launch file '{name}' does not exist{did_you_mean(name, package_names())}"


def find_launch_file(package: str, name: str) -> Path:
    """Return the launch file of a name in a package's share folder.

    Raises
    ------
    CliError
        When the package or the file is not there, or the name is that of several files.
    """
    from ament_index_python.packages import PackageNotFoundError, get_package_share_path

    from daidalos.cli.ros2.packages import package_names
    from daidalos.cli.ros2.workspace_hints import unknown_package

    try:
        share = get_package_share_path(package)
    except (PackageNotFoundError, ValueError):
        hint = unknown_package(package) or did_you_mean(package, package_names())
        raise CliError(f"Package '{package}' not found{hint}") from None
    found = [
        path for path in sorted(share.rglob(Path(name).name)) if path.is_file() and path.as_posix().endswith(f"/{name}")
    ]
    if not found:
        files = [file.name for file in launch_files(package)]
        hint = did_you_mean(name, files) or (f"\nThere are: {', '.join(files)}" if files else "")
        raise CliError(
            f"file '{name}' was not found in the share directory of package '{package}' which is at '{share}'{hint}",
            _FAULTY_FILE,
        )
    if len(found) > 1:
        listed = "".join(f"\n- {path}" for path in found)
        raise CliError(
            f"file '{name}' was found more than once in the share directory of package '{package}':{listed}",
            _FAULTY_FILE,
        )
    return found[0]


def launch_files(package: str) -> list[Path]:
    """Return the launch files of a package, none if it does not exist."""
    from ament_index_python.packages import PackageNotFoundError, get_package_share_path

    try:
        share = get_package_share_path(package)
    except (PackageNotFoundError, ValueError):
        return []
    return [path for path in sorted(share.rglob("*")) if path.name.endswith(_ENDINGS)]


def _load(path: Path) -> tuple[LaunchDescriptionSource, LaunchDescription]:
    """Read a launch file; CliError, with file and line, on failure."""
    from launch import LaunchContext
    from launch.launch_description_sources import AnyLaunchDescriptionSource
    from launch.launch_file_error import LaunchFileError

    source = AnyLaunchDescriptionSource(str(path))
    try:
        return source, source.get_launch_description(LaunchContext())
    # A launch file is a program: it may raise anything.
    except Exception as error:
        raise CliError(str(LaunchFileError.from_exception(error, str(path))), _FAULTY_FILE) from error


def _complete_first(prefix: str, **_: Any) -> list[str]:
    """Return packages, and launch files as paths; completer."""
    from argcomplete.completers import FilesCompleter

    from daidalos.cli.ros2.packages import package_names

    files: list[str] = FilesCompleter(("py", "xml", "yaml", "yml", "launch"))(prefix)
    return [*package_names(), *files]


def _complete_argument(prefix: str, args: Any) -> list[str]:
    """Return the names of launch arguments, and the choices of a typed one; completer."""
    try:
        path, _ = _file_and_arguments(args)
        declared = _load(path)[1].get_launch_arguments()
    except CliError:
        return []  # the preceding argument is incomplete
    name, separator, _ = prefix.partition(":=")
    if not separator:
        return [f"{argument.name}:=" for argument in declared]
    return [f"{name}:={choice}" for argument in declared if argument.name == name for choice in argument.choices or ()]
