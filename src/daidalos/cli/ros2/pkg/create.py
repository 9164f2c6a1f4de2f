"""`ros2 pkg create`."""

from __future__ import annotations

import getpass
import subprocess
import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path

from daidalos.cli.ros2.completion import complete_packages
from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.extension import Status, Verb
from daidalos.cli.ros2.new_package import NewPackage, files_of
from daidalos.cli.ros2.new_package.licenses import LICENSES, license_text

_BUILD_TYPES = ("cmake", "ament_cmake", "ament_python")
_NO_LICENSE = "TODO: License declaration"


class CreateVerb(Verb):
    """Create a new ROS 2 package."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the arguments."""
        parser.add_argument("package_name", help="The package name")
        parser.add_argument(
            "--package-format",
            "--package_format",
            type=int,
            choices=(2, 3),
            default=3,
            help="The package.xml format.",
        )
        parser.add_argument(
            "--description", default="TODO: Package description", help="The description given in the package.xml"
        )
        parser.add_argument(
            "--license",
            default=_NO_LICENSE,
            help="The license attached to this package; this can be an arbitrary string, but a LICENSE file will only "
            "be generated if it is one of the supported licenses (pass '?' to get a list)",
        )
        parser.add_argument(
            "--destination-directory", default=".", help="Directory where to create the package directory"
        )
        parser.add_argument(
            "--build-type",
            choices=_BUILD_TYPES,
            default="ament_cmake",
            help="The build type to process the package with",
        )
        complete_packages(parser.add_argument("--dependencies", nargs="+", default=[], help="list of dependencies"))
        parser.add_argument("--maintainer-email", help="email address of the maintainer of this package")
        parser.add_argument(
            "--maintainer-name", default=getpass.getuser(), help="name of the maintainer of this package"
        )
        parser.add_argument("--node-name", help="name of the empty executable")
        parser.add_argument("--library-name", help="name of the empty library")

    def main(self, *, args: Namespace) -> Status:
        """Create the package, and print its settings and files."""
        if args.license == "?":
            print("\n".join(("Supported licenses:", *LICENSES)))
            return 0
        folder = Path(args.destination_directory) / args.package_name
        package = _package(args)
        _check(package, folder)
        _announce(package, args.destination_directory)
        _write(package, args.destination_directory)
        if args.license not in LICENSES:
            listed = "\n".join(LICENSES)
            print(
                f"\n[WARNING]: Unknown license '{args.license}'.  This has been set in the package.xml, but no LICENSE "
                "file has been created.\n"
                f"It is recommended to use one of the ament license identifiers:\n{listed}"
            )
        return 0


def _package(args: Namespace) -> NewPackage:
    node_name = args.node_name
    if node_name and node_name == args.library_name:
        node_name = f"{args.library_name}_node"
        print("[WARNING] node name can not be equal to the library name", file=sys.stderr)
        print(f"[WARNING] renaming node to {node_name}", file=sys.stderr)
    return NewPackage(
        name=args.package_name,
        package_format=args.package_format,
        description=args.description,
        maintainer_name=args.maintainer_name,
        maintainer_email=args.maintainer_email or _email(),
        license=args.license,
        build_type=args.build_type,
        dependencies=tuple(args.dependencies),
        node_name=node_name,
        library_name=args.library_name,
    )


def _email() -> str:
    """Return the user's e-mail address from git's configuration."""
    try:
        asked = subprocess.run(["git", "config", "--get", "user.email"], capture_output=True, text=True, check=False)
        found = asked.stdout.strip()
    except OSError:
        found = ""
    return found or f"{getpass.getuser()}@todo.todo"


def _check(package: NewPackage, folder: Path) -> None:
    fault = package.fault()
    if fault:
        raise CliError(f"\nAborted!\n{fault}")
    if folder.exists():
        raise CliError(
            f"\nAborted!\nThe directory already exists: {_dotted(folder)}\n"
            "Either remove the directory or choose a different destination directory or package name"
        )
    if not folder.parent.is_dir():
        raise CliError(f"\nAborted!\nThe destination directory does not exist: {folder.parent}")


def _announce(package: NewPackage, destination: str) -> None:
    print("going to create a new package")
    print(f"package name: {package.name}")
    print(f"destination directory: {Path(destination).resolve()}")
    print(f"package format: {package.package_format}")
    print("version: 0.0.0")
    print(f"description: {package.description}")
    print(f"maintainer: {[f'{package.maintainer_name} <{package.maintainer_email}>']}")
    print(f"licenses: {[package.license]}")
    print(f"build type: {package.build_type}")
    print(f"dependencies: {list(package.dependencies)}")
    if package.node_name:
        print(f"node_name: {package.node_name}")
    if package.library_name:
        print(f"library_name: {package.library_name}")


def _write(package: NewPackage, destination: str) -> None:
    base = Path(destination)
    created = {base}
    for entry in files_of(package):
        if entry.note:
            print(entry.note)
        path = base / package.name / entry.path
        folder = path if entry.text is None else path.parent
        if folder not in created:
            print(f"creating folder {_dotted(folder)}")
            folder.mkdir(parents=True)
            created.add(folder)
        if entry.text is not None:
            print(f"creating {_dotted(path)}")
            path.write_text(entry.text, encoding="utf-8")
    text = license_text(package.license, package.maintainer_name)
    if text:
        (base / package.name / "LICENSE").write_text(text, encoding="utf-8")


def _dotted(path: Path) -> str:
    """Return a path as typed, with a leading dot for one in the working directory."""
    return str(path) if path.is_absolute() or path.parts[:1] == ("..",) else f".{'/' if path.parts else ''}{path}"
