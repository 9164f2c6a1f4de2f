"""Meshes and textures for the page: finds what ``package://`` and ``file://`` name, and nothing else."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urlsplit
from urllib.request import url2pathname

EXTENSIONS = frozenset(
    {
        ".bmp", ".dae", ".gif", ".glb", ".gltf", ".bin", ".jpeg", ".jpg", ".mtl", ".obj", ".png", ".ply",
        ".stl", ".svg", ".tga", ".tif", ".tiff", ".urdf", ".webp",
    }
)  # fmt: skip
LIMIT_BYTES = 512 << 20
_FILE_REFERENCE = re.compile(r"""["'](file://[^"']+)["']""")


class AssetError(Exception):
    """An asset that is missing or may not be read; the text is shown to the client."""


class AssetResolver:
    """Reads assets from packages' share directories and from where robot descriptions point.

    Parameters
    ----------
    share_directory
        Finds a package's share directory; None when there is no such package.
    directories
        More directories whose files may be read by ``file://``.
    """

    def __init__(self, share_directory: Callable[[str], Path | None], directories: Iterable[Path] = ()) -> None:
        self._share_directory = share_directory
        self._directories = {_normal(Path(directory)) for directory in directories}

    def allow_meshes_of(self, description: str) -> None:
        """Allow the folders of the files that a robot's description names by ``file://``.

        Folders, because a mesh has its textures beside it; the list of extensions still holds.
        """
        for uri in _FILE_REFERENCE.findall(description):
            self.allow(uri)

    def allow(self, uri: str) -> None:
        """Allow the folder of a mesh or texture that is named by ``file://``; other addresses change nothing."""
        path = _file_path(uri) if uri.startswith("file://") else None
        if path is not None and path.suffix.lower() in EXTENSIONS:
            self._directories.add(path.parent)

    def read(self, uri: str) -> bytes:
        """Return the bytes of an asset.

        Raises
        ------
        AssetError
            When the scheme is unknown, the file is absent, too large, or outside of what may be read.
        """
        path = self._locate(uri)
        if path.suffix.lower() not in EXTENSIONS:
            raise AssetError(f"{uri}: {path.suffix or 'a file without extension'} is not a mesh or texture")
        try:
            if path.stat().st_size > LIMIT_BYTES:
                raise AssetError(f"{uri}: larger than {LIMIT_BYTES >> 20} MiB")
            return path.read_bytes()
        except FileNotFoundError:
            raise AssetError(f"{uri}: no such file") from None
        except (OSError, ValueError) as error:
            reason = error.strerror if isinstance(error, OSError) else str(error)
            raise AssetError(f"{uri}: {reason}") from None

    def _locate(self, uri: str) -> Path:
        try:
            parts = urlsplit(uri)
        except ValueError:
            raise AssetError(f"{uri}: not a URI") from None
        if parts.scheme == "package":
            return self._in_package(uri, parts.netloc, unquote(parts.path))
        if parts.scheme == "file":
            path = _file_path(uri)
            if any(path.is_relative_to(directory) for directory in self._directories):
                return path
            raise AssetError(f"{uri}: outside of the packages and of what robot descriptions name")
        raise AssetError(f"{uri}: expected package:// or file://")

    def _in_package(self, uri: str, package: str, path: str) -> Path:
        share = self._share_directory(package)
        if share is None:
            raise AssetError(f"{uri}: no package {package!r}")
        relative = PurePosixPath(path.lstrip("/"))
        # By name, not by what links resolve to: --symlink-install makes a workspace link to its sources.
        if ".." in relative.parts or "\\" in path:
            raise AssetError(f"{uri}: leaves its package")
        return share.joinpath(*relative.parts)


def _file_path(uri: str) -> Path:
    return _normal(Path(url2pathname(uri.removeprefix("file://"))))


def _normal(path: Path) -> Path:
    """Resolve ``..`` by name; what may be read is decided on the result."""
    parts: list[str] = []
    for part in path.absolute().parts:
        if part == "..":
            parts = parts[:-1] or parts
        else:
            parts.append(part)
    return Path(*parts)
