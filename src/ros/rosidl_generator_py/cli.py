"""Generator of Python classes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ament_index_python.search_paths import get_all_prefixes
from rosidl_cli.command.generate.extensions import GenerateCommandExtension
from rosidl_cli.command.helpers import interface_path_as_tuple

from daidalos.interfaces.definition import Interface, messages_of
from daidalos.interfaces.generator import write_modules
from daidalos.interfaces.library import BUILT_IN, InterfaceNotFound, Library, read_definition


class GeneratePython(GenerateCommandExtension):
    """Generator of the Python package of interface files.

    Parameters
    ----------
    name
        Name of its entry point.
    typesupport_implementations
        Taken for the sake of callers: the classes need no compiled type support.
    """

    def __init__(self, name: str, *, typesupport_implementations: Sequence[str] | None = None) -> None:
        super().__init__(name)

    def generate(
        self, package_name: str, interface_files: list[str], include_paths: list[str], output_path: Path
    ) -> list[str]:
        """Write the package's modules to `output_path`, such as ``msg/_num.py``, and return their paths.

        Types of other packages are looked for below `include_paths`, in the installed packages and the built-in ones.

        Raises
        ------
        InterfaceError
            Naming the file and the line at fault.
        RuntimeError
            When a type that is referred to is not known.
        """
        files = [prefix / path for prefix, path in map(interface_path_as_tuple, interface_files)]
        own = {}
        for path in files:
            interface = read_definition(path, package_name)
            own[interface.name] = interface
        shares = [*map(Path, include_paths), *(Path(prefix) / "share" for prefix in get_all_prefixes()), BUILT_IN]
        library = Library(shares)
        parts = {message.name: message for interface in own.values() for message in messages_of(interface)}

        def lookup(name: str) -> Interface:
            return own.get(name) or parts.get(name) or library.get(name)

        try:
            written = write_modules(package_name, own.values(), lookup, output_path)
        except InterfaceNotFound as error:
            raise RuntimeError(f"{error} in {', '.join(map(str, shares))}; name its folder with -I") from None
        return [str(path) for path in written]
