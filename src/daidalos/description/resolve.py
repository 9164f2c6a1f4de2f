"""Resolution of the URIs of meshes and models: package://, model://, file:// and paths."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from urllib.parse import unquote, urlparse
from urllib.request import url2pathname

from daidalos.description.fuel import fuel_candidates

PackageResolver = Callable[[str], Path | str | None]
"""Takes a package's name, returns its share directory, or None when there is no such package."""

_MODEL_PATH_VARIABLES = (
    "GZ_SIM_RESOURCE_PATH",
    "IGN_GAZEBO_RESOURCE_PATH",
    "GAZEBO_MODEL_PATH",
    "GAZEBO_RESOURCE_PATH",
    "SDF_PATH",
)


def resolve_uri(
    uri: str,
    base: Path | None = None,
    packages: PackageResolver | None = None,
    model_path: Sequence[Path] = (),
) -> Path | None:
    """Find the file or folder of a URI.

    Parameters
    ----------
    uri : str
        ``package://name/path``, ``model://name/path``, ``file://path``, an absolute path, a path
        relative to `base`, or an address of Gazebo Fuel, see `fuel_candidates`.
    base : Path or None
        Folder of the file that holds `uri`. What neither `packages` nor `model_path` know is looked for
        around it, see `packages_near`.
    packages : callable or None
        Share directory of a package.
    model_path : sequence of Path
        Folders that hold models.

    Returns
    -------
    Path or None
        An existing path, or None.
    """
    scheme, separator, rest = uri.partition("://")
    candidates: Iterable[Path]
    if not separator:
        candidates = _relative(uri, base, model_path)
    elif scheme == "file":
        candidates = _file(uri, rest, base, model_path)
    elif scheme in ("package", "model"):
        candidates = _named(scheme, unquote(rest), base, packages, model_path)
    elif scheme in ("http", "https"):
        candidates = fuel_candidates(uri, model_path)
    else:
        return None
    return next((path for path in candidates if path.exists()), None)


def environment_model_path() -> tuple[Path, ...]:
    """Return the folders in Gazebo's environment variables."""
    return tuple(
        Path(folder)
        for variable in _MODEL_PATH_VARIABLES
        for folder in os.environ.get(variable, "").split(os.pathsep)
        if folder
    )


def default_model_path() -> tuple[Path, ...]:
    """Return the folders in Gazebo's environment variables, and the user's own models."""
    return (*environment_model_path(), Path.home() / ".gazebo" / "models")


def packages_near(name: str, folder: Path) -> Iterator[Path]:
    """Yield folders that may be an uninstalled package or model.

    These are the folders around `folder` that are called so or whose ``package.xml`` says so, and what lies
    beside one of them under that name, as in the source folder of a workspace, or in a folder of ``models``
    there; the nearest comes first.
    """
    here = folder.absolute()
    for around in (here, *here.parents[:-1]):
        if around.name == name or _package_name(around / "package.xml") == name:
            yield around
        yield from (folder for folder in (around / name, around / "models" / name) if folder.is_dir())


def texture_file(path: Path) -> Path:
    """Return the file of a texture that a mesh names: `path`, or its namesake in the model's ``materials/textures``.

    Gazebo's models keep textures there, beside the folder of the meshes that name them.
    """
    if path.exists():
        return path
    in_materials = path.parent.parent / "materials" / "textures" / path.name
    return in_materials if in_materials.is_file() else path


def _package_name(manifest: Path) -> str:
    try:
        found = re.search(rb"<name>\s*([^<\s]+)\s*</name>", manifest.read_bytes())
    except OSError:
        return ""
    return found[1].decode(errors="replace") if found else ""


def _relative(uri: str, base: Path | None, model_path: Sequence[Path]) -> list[Path]:
    path = Path(uri)
    if path.is_absolute():
        return [path]
    folders = [] if base is None else [base]
    return [folder / path for folder in (*folders, *model_path)]


def _file(uri: str, rest: str, base: Path | None, model_path: Sequence[Path]) -> Iterator[Path]:
    if rest.startswith("/"):
        yield Path(url2pathname(urlparse(uri).path))
        return
    yield from _relative(unquote(rest), base, model_path)
    yield from _near(unquote(rest), base)


def _named(
    scheme: str, rest: str, base: Path | None, packages: PackageResolver | None, model_path: Sequence[Path]
) -> Iterator[Path]:
    in_models = [folder / rest for folder in model_path]
    if scheme == "package":
        yield from _packaged(rest, packages)
        yield from in_models
    else:
        yield from in_models
        yield from _packaged(rest, packages)
    yield from _near(rest, base)


def _packaged(rest: str, packages: PackageResolver | None) -> Iterator[Path]:
    name, _, inside = rest.partition("/")
    share = packages(name) if packages is not None else None
    if share is not None:
        yield Path(share) / inside


def _near(rest: str, base: Path | None) -> Iterator[Path]:
    name, _, inside = rest.partition("/")
    if base is not None:
        yield from (folder / inside for folder in packages_near(name, base))
