"""Lookup of worlds: files, the simulators' resource paths, and the `worlds` folders of packages."""

from __future__ import annotations

from pathlib import Path

from daidalos.description.resolve import default_model_path
from daidalos.nodes.packages import package_share

_EMPTY = ("", "empty.world", "worlds/empty.world", "empty.sdf")


def find_world(name: str) -> Path | None:
    """Return the file of a world: as it is, in the resource paths, or among packages' worlds; None is empty.

    Raises
    ------
    FileNotFoundError
    """
    if name in _EMPTY:
        return None
    path = Path(name)
    paths = default_model_path()
    places = [Path(), *paths, *(path / "worlds" for path in paths), *([] if path.is_absolute() else world_folders())]
    found = next((place / path for place in places if (place / path).is_file()), None)
    if found is None:
        raise FileNotFoundError(f"there is no world file '{name}'")
    return found


def world_folders() -> list[Path]:
    """Return the `worlds` folders of all packages, whether they have one or not."""
    from ament_index_python.packages import get_packages_with_prefixes

    shares = (package_share(name) for name in get_packages_with_prefixes())
    return [Path(share) / "worlds" for share in shares if share is not None]


def worlds_in(folder: Path) -> list[Path]:
    """Return the files of a folder that look like worlds."""
    return [file for pattern in ("*.world", "*.sdf") for file in folder.glob(pattern)] if folder.is_dir() else []
