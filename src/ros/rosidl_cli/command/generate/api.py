"""Generation of source code with all generators that are wanted."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rosidl_cli.command.generate.extensions import load_type_extensions, load_typesupport_extensions


def generate(
    *,
    package_name: str,
    interface_files: list[str],
    include_paths: list[str] | None = None,
    output_path: Path | None = None,
    types: Sequence[str] | None = None,
    typesupports: Sequence[str] | None = None,
) -> list[list[str]]:
    """Generate source code from interface files; with neither types nor type supports, all that are installed.

    Parameters
    ----------
    package_name
        The package that the code is for.
    interface_files
        Its interface files; see `rosidl_cli.command.helpers.interface_path_as_tuple`.
    include_paths
        Folders with the interface files of other packages.
    output_path
        Where the code goes, the current folder without it; a folder in it for each generator if there are several.
    types
        Languages of the classes, such as ``py``.
    typesupports
        Support code of middlewares.

    Returns
    -------
    list of list
        The paths of the files of each generator.

    Raises
    ------
    RuntimeError
        When there is no such generator.
    """
    every = not types and not typesupports
    extensions = []
    if types or every:
        extensions += load_type_extensions(specs=types or None, strict=not every)
    if typesupports or every:
        extensions += load_typesupport_extensions(specs=typesupports or None, strict=not every)
    if not extensions:
        raise RuntimeError("No type nor typesupport extensions were found")
    folder = Path.cwd() if output_path is None else Path(output_path)
    folder.mkdir(parents=True, exist_ok=True)
    several = len(extensions) > 1
    return [
        one.generate(package_name, interface_files, include_paths or [], folder / one.name if several else folder)
        for one in extensions
    ]
