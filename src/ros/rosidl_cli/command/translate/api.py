"""Translation of interface files with the translators that fit."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rosidl_cli.command.translate.extensions import load_translate_extensions


def translate(
    *,
    package_name: str,
    interface_files: list[str],
    output_format: str,
    input_format: str | None = None,
    include_paths: list[str] | None = None,
    output_path: Path | None = None,
    translators: Sequence[str] | None = None,
) -> list[str]:
    """Translate interface files from one format to another.

    Parameters
    ----------
    package_name
        The package that the files belong to.
    interface_files
        The files; see `rosidl_cli.command.helpers.interface_path_as_tuple`.
    output_format
        Format to write, such as ``idl``.
    input_format
        Format of all files; what each one's name ends in without it.
    include_paths
        Folders with the interface files of other packages.
    output_path
        Folder to write to, the current one without it.
    translators
        Which translators may be used; all that are installed without it.

    Returns
    -------
    list of str
        The written files as ``folder:path``.

    Raises
    ------
    RuntimeError
        When no translator fits.
    """
    extensions = load_translate_extensions(specs=translators or None, strict=bool(translators))
    by_formats = {(one.input_format, one.output_format): one for one in reversed(extensions)}
    groups: dict[str, list[str]] = {}
    for file in interface_files:
        groups.setdefault(input_format or Path(file).suffix[1:], []).append(file)
    for kind, files in groups.items():
        if (kind, output_format) not in by_formats:
            choice = ", ".join(f"{one.input_format} to {one.output_format}" for one in extensions) or "none"
            raise RuntimeError(
                f"no translator from '{kind}' to '{output_format}' for {', '.join(files)}; there are: {choice}"
            )
    folder = Path.cwd() if output_path is None else Path(output_path)
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for kind, files in groups.items():
        written += by_formats[kind, output_format].translate(package_name, files, include_paths or [], folder)
    return written
