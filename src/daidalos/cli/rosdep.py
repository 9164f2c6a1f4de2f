"""Command `rosdep`: dependencies of packages, and their installation."""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from daidalos.common.suggestions import hint_line
from daidalos.workspaces.errors import WorkspaceError
from daidalos.workspaces.rosdep.keys import Answer, Resolution, resolve
from daidalos.workspaces.rosdep.packages import TYPES, PackageDependencies, find


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit status.

    Parameters
    ----------
    argv
        The arguments; those of the process where None.
    """
    args = _parser().parse_args(sys.argv[1:] if argv is None else argv)
    run: Callable[[argparse.Namespace], int] = args.run
    try:
        return run(args)
    except WorkspaceError as error:
        print(f"ERROR: {error}", file=sys.stderr)
        return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="rosdep", description="Tells what packages depend on, and installs what is missing."
    )
    commands = parser.add_subparsers(title="commands", required=True, metavar="command")
    for name, run, text in (
        ("check", _check, "check whether the dependencies of packages are there"),
        ("install", _install, "install the dependencies of packages"),
        ("keys", _keys, "list the names of the dependencies of packages"),
    ):
        _add_package_arguments(_add(commands, name, run, text))
    resolver = _add(commands, "resolve", _resolve, "show the resolution of dependencies")
    resolver.add_argument("keys", nargs="+", metavar="key")
    resolver.add_argument("--rosdistro", help=argparse.SUPPRESS)
    for name, text in (("init", "nothing has to be initialized"), ("update", "nothing has to be updated")):
        nothing = _add(commands, name, _nothing, text)
        nothing.add_argument("--rosdistro", help=argparse.SUPPRESS)
        nothing.add_argument("--include-eol-distros", action="store_true", help=argparse.SUPPRESS)
    return parser


def _add(
    commands: argparse._SubParsersAction[argparse.ArgumentParser],
    name: str,
    run: Callable[[argparse.Namespace], int],
    text: str,
) -> argparse.ArgumentParser:
    parser = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")
    parser.set_defaults(run=run)
    return parser


def _add_package_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("packages", nargs="*", metavar="package", help="a package below the paths, or a folder with packages")
    add("--from-paths", "--from-path", dest="paths", nargs="+", default=[], type=Path, help="folders with packages")
    add("-i", "--ignore-packages-from-source", "--ignore-src", dest="ignore_source", action="store_true",
        help="leave out what is among these packages itself")  # fmt: skip
    add("-a", "--all", action="store_true", help="all packages below the current folder")
    add("-y", "--default-yes", dest="yes", action="store_true", help="do not ask")
    add("-s", "--simulate", action="store_true", help="only show what would be done")
    add("-r", "--recover", action="store_true", help="go on after a failure")
    add("-q", "--quiet", action="store_true", help="say less")
    add("-t", "--dependency-types", choices=TYPES, action="append", default=[], help="only this kind of dependency")
    add("--skip-keys", action="append", default=[], help="names to leave out, separated by spaces")
    add("--rosdistro", help="accepted as ROS 2 does; there is one distribution here")
    add("--reinstall", action="store_true", help=argparse.SUPPRESS)
    add("--os", help=argparse.SUPPRESS)


def _keys(args: argparse.Namespace) -> int:
    for key in _all_keys(_needs(args)):
        print(key)
    return 0


def _check(args: argparse.Namespace) -> int:
    needs = _needs(args)
    if unknown := _unknown(needs):
        return _report_unknown(unknown)
    missing = _missing(needs)
    _report_left_out(needs)
    if not missing:
        print("All system dependencies have been satisfied")
        return 0
    print("System dependencies have not been satisfied:")
    for distribution in missing:
        print(f"pip\t{distribution}")
    return 1


def _install(args: argparse.Namespace) -> int:
    needs = _needs(args)
    unknown = _unknown(needs)
    if unknown and not args.recover:
        return _report_unknown(unknown)
    missing = _missing(needs)
    if args.simulate:
        print("#[pip] Installation commands:" if missing else "#No packages to install")
        if missing:
            print(f"  {' '.join(_installer())} {' '.join(missing)}")
        return 0
    if missing and not _run_installer(missing, args.yes):
        return 1
    if not args.quiet:
        _report_left_out(needs)
    if unknown:
        return _report_unknown(unknown)
    print("#All required rosdeps installed successfully")
    return 0


def _report_left_out(needs: Sequence[PackageDependencies]) -> None:
    """Print which dependencies are not here although nothing has to be installed for a build."""
    keys = {answer: [key for key in _all_keys(needs) if resolve(key).answer is answer] for answer in Answer}
    if keys[Answer.COMPILED]:
        print(f"#Only C++ needs {', '.join(keys[Answer.COMPILED])}: targets that do are left out of a build here")
    if keys[Answer.ABSENT]:
        print(f"#These packages of ROS 2 do not come with Daidalos: {', '.join(keys[Answer.ABSENT])}")


def _resolve(args: argparse.Namespace) -> int:
    status = 0
    for key in args.keys:
        resolution = resolve(key)
        if resolution.answer is Answer.UNKNOWN:
            print(f"ERROR: no rosdep rule for '{key}'", file=sys.stderr)
            status = 1
            continue
        if len(args.keys) > 1:
            print(f"#ROSDEP[{key}]")
        print("#pip" if resolution.distribution else "#daidalos")
        print(resolution.distribution or _words(resolution))
    return status


def _words(resolution: Resolution) -> str:
    words = {
        Answer.COMPILED: "# does not come with Daidalos; C++ targets that need it are left out of a build",
        Answer.ABSENT: "# does not come with Daidalos; a build does not need it",
    }
    return words.get(resolution.answer, "# comes with Daidalos")


def _nothing(args: argparse.Namespace) -> int:
    print("Nothing to do: what packages may depend on is known without a list from elsewhere.")
    return 0


def _needs(args: argparse.Namespace) -> list[PackageDependencies]:
    """Return the requested packages with the selected types of dependencies."""
    folders = args.paths or [Path()]
    for folder in folders:
        if not folder.is_dir():
            raise WorkspaceError(f"the path '{folder}' does not exist")
    if not (args.paths or args.packages or args.all):
        raise WorkspaceError("name a package, or folders with --from-paths")
    found = find(folders, args.dependency_types or TYPES)
    names = {needs.package for needs in found}
    for package in args.packages:
        if package not in names:
            raise WorkspaceError(f"no package '{package}' below {', '.join(map(str, folders))}")
    skipped = {key for text in args.skip_keys for key in text.split()} | (names if args.ignore_source else set())
    return [
        PackageDependencies(needs.package, tuple(key for key in needs.keys if key not in skipped))
        for needs in found
        if not args.packages or needs.package in args.packages
    ]


def _all_keys(needs: Sequence[PackageDependencies]) -> list[str]:
    return sorted({key for one in needs for key in one.keys})


def _unknown(needs: Sequence[PackageDependencies]) -> dict[str, list[str]]:
    found = {one.package: [key for key in one.keys if resolve(key).answer is Answer.UNKNOWN] for one in needs}
    return {package: keys for package, keys in found.items() if keys}


def _missing(needs: Sequence[PackageDependencies]) -> list[str]:
    resolutions = (resolve(key) for key in _all_keys(needs))
    return list(dict.fromkeys(one.distribution for one in resolutions if one.answer is Answer.PYTHON))


def _report_unknown(unknown: dict[str, list[str]]) -> int:
    from daidalos.cli.ros2.packages import package_names

    print(
        "ERROR: the following packages/stacks could not have their rosdep keys resolved\nto system dependencies:",
        file=sys.stderr,
    )
    for package, keys in unknown.items():
        print(f"{package}: Cannot locate rosdep definition for [{', '.join(keys)}]", file=sys.stderr)
        for key in keys:
            sys.stderr.write(hint_line(key, package_names()))
    return 1


def _installer() -> list[str]:
    from importlib.util import find_spec

    if find_spec("pip") is None and (uv := shutil.which("uv")):
        return [uv, "pip", "install", "--python", sys.executable]
    return [sys.executable, "-m", "pip", "install"]


def _run_installer(distributions: Sequence[str], yes: bool) -> bool:
    command = [*_installer(), *distributions]
    print(f"executing command [{' '.join(command)}]")
    if not yes and input("Continue? [Y/n] ").strip().lower() not in ("", "y", "yes"):
        return False
    if subprocess.run(command, check=False).returncode == 0:
        return True
    print(f"ERROR: the following rosdeps failed to install\n  pip: {', '.join(distributions)}", file=sys.stderr)
    return False
