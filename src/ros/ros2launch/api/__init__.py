"""Launch files of packages: where they are, their arguments, and how they are launched."""

from __future__ import annotations

import os
from argparse import Namespace
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from launch.invalid_launch_file_error import InvalidLaunchFileError as InvalidLaunchFileError

if TYPE_CHECKING:
    from launch import LaunchDescription, LaunchDescriptionSource


class MultipleLaunchFilesError(Exception):
    """Error of a name that several launch files of a package have.

    Parameters
    ----------
    msg
        Message.
    paths
        The files.
    """

    def __init__(self, msg: str, paths: Sequence[str]) -> None:
        super().__init__(msg)
        self.paths = paths


def get_share_file_path_from_package(*, package_name: str, file_name: str) -> str:
    """Return the path of a file in the share folder of a package.

    Raises
    ------
    PackageNotFoundError
        When there is no such package.
    FileNotFoundError
        When the package has no file of this name.
    MultipleLaunchFilesError
        When it has several.
    """
    from ament_index_python.packages import get_package_share_path

    share = get_package_share_path(package_name)
    found = sorted(str(path) for path in share.rglob(file_name) if path.is_file())
    described = f"in the share directory of package '{package_name}' which is at '{share}'"
    if not found:
        raise FileNotFoundError(f"file '{file_name}' was not found {described}")
    if len(found) > 1:
        raise MultipleLaunchFilesError(f"file '{file_name}' was found more than once {described}: {found}", found)
    return found[0]


def get_launch_file_paths(*, path: str) -> list[str]:
    """Return the launch files in a folder and those below it, sorted."""
    return sorted(str(file) for file in Path(path).rglob("*") if is_launch_file(str(file)))


def is_launch_file(path: str) -> bool:
    """Return whether a path is that of a launch file in a language that can be read."""
    from launch.frontend import Parser

    return path.endswith(("launch.py", *Parser.get_file_extensions_from_parsers())) and os.path.isfile(path)


def print_a_launch_file(*, launch_file_path: str) -> None:
    """Print what a launch file describes."""
    from launch import LaunchIntrospector

    print(LaunchIntrospector().format_launch_description(_description(launch_file_path)))  # noqa: T201


def print_arguments_of_launch_file(*, launch_file_path: str) -> None:
    """Print the arguments of a launch file."""
    print_arguments_of_launch_description(launch_description=_description(launch_file_path))


def print_arguments_of_launch_description(*, launch_description: LaunchDescription) -> None:
    """Print the arguments of a launch description."""
    print(arguments_text(launch_description))  # noqa: T201


def arguments_text(description: LaunchDescription) -> str:
    """Return the arguments of a launch description as text."""
    lines = ["Arguments (pass arguments as '<name>:=<value>'):"]
    declared = description.get_launch_arguments()
    for argument in declared:
        lines += ["", f"    '{argument.name}':", f"        {argument.description}"]
        if argument.default_value is not None:
            default = " + ".join(part.describe() for part in argument.default_value)
            lines.append(f"        (default: {default})")
    return "\n".join(lines if declared else [*lines, "", "  No arguments."])


def parse_launch_arguments(launch_arguments: Iterable[str]) -> list[tuple[str, str]]:
    """Return launch arguments as (name, value), the last of each name.

    Raises
    ------
    RuntimeError
        When one is not ``<name>:=<value>``.
    """
    arguments = {}
    for word in launch_arguments:
        name, separator, value = word.partition(":=")
        if not separator or not name:
            raise RuntimeError(f"malformed launch argument '{word}', expected format '<name>:=<value>'")
        arguments[name] = value
    return list(arguments.items())


def launch_a_launch_file(
    *,
    launch_file_path: str,
    launch_file_arguments: Sequence[str],
    noninteractive: bool = False,
    args: Namespace | None = None,
    option_extensions: Mapping[str, Any] | None = None,
    debug: bool = False,
) -> int:
    """Run a launch file until all of its processes have ended; return the exit status.

    Parameters
    ----------
    launch_file_path
        The file.
    launch_file_arguments
        Its arguments, each ``<name>:=<value>``.
    noninteractive
        Whether no terminal is attached.
    args
        Options of `ros2 launch`; ``launch_prefix`` and ``launch_prefix_filter`` become launch arguments.
    option_extensions
        Objects of `ros2launch.option.OptionExtension` by name.
    debug
        Whether to log what is launched in detail.
    """
    from launch.launch_description_sources import AnyLaunchDescriptionSource

    return launch_source(
        AnyLaunchDescriptionSource(launch_file_path),
        launch_file_arguments,
        noninteractive=noninteractive,
        args=args,
        option_extensions=option_extensions,
        debug=debug,
    )


def launch_source(
    source: LaunchDescriptionSource,
    arguments: Sequence[str],
    *,
    noninteractive: bool = False,
    args: Namespace | None = None,
    option_extensions: Mapping[str, Any] | None = None,
    debug: bool = False,
) -> int:
    """Run the source of a launch description; see `launch_a_launch_file`."""
    from launch import LaunchDescription, LaunchService
    from launch.actions import IncludeLaunchDescription

    extensions = [extension for _, extension in sorted((option_extensions or {}).items())]
    for extension in extensions:
        extension.prestart(args)
    words = list(arguments)
    parsed = parse_launch_arguments(words)
    for option in ("launch_prefix", "launch_prefix_filter"):
        if getattr(args, option, None) is not None:
            parsed.append((option.replace("_", "-"), getattr(args, option)))
    service = LaunchService(argv=words, noninteractive=noninteractive, debug=debug)
    description = LaunchDescription([IncludeLaunchDescription(source, launch_arguments=parsed)])
    for extension in extensions:
        description = extension.prelaunch(description, args)[0]
    service.include_launch_description(description)
    status = service.run()
    for extension in extensions:
        extension.postlaunch(status, args)
    return status


class LaunchFileNameCompleter:
    """Completer of the launch files of the package that another argument names.

    Parameters
    ----------
    package_name_key
        The other argument.
    """

    def __init__(self, *, package_name_key: str = "package_name") -> None:
        self.package_name_key = package_name_key

    def __call__(self, prefix: str, parsed_args: Namespace, **kwargs: Any) -> list[str]:
        """Return their names."""
        from ament_index_python.packages import PackageNotFoundError, get_package_share_directory

        try:
            share = get_package_share_directory(getattr(parsed_args, self.package_name_key))
        except (PackageNotFoundError, ValueError):
            return []
        return [os.path.basename(path) for path in get_launch_file_paths(path=share)]


def _description(path: str) -> LaunchDescription:
    from launch.launch_description_sources import get_launch_description_from_any_launch_file

    return get_launch_description_from_any_launch_file(path)
