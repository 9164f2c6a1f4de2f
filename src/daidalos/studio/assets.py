"""Meshes and textures for the page: finds what ``package://`` and ``file://`` name, and nothing else."""

from __future__ import annotations

import stat
from collections.abc import Callable
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urlsplit
from urllib.request import url2pathname

from daidalos.description.resolve import texture_file

EXTENSIONS = frozenset(
    {
        ".bmp", ".dae", ".gif", ".glb", ".gltf", ".bin", ".jpeg", ".jpg", ".mtl", ".obj", ".png", ".ply",
        ".stl", ".svg", ".tga", ".tif", ".tiff", ".urdf", ".webp",
    }
)  # fmt: skip
LIMIT_BYTES = 512 << 20
MAX_URI_LENGTH = 4096


class AssetError(Exception):
    """An asset that is missing or may not be read; the text is shown to the client."""


class AssetRefusedError(AssetError):
    """An asset outside of the folders that may be read."""


class AssetResolver:
    """Reads assets from packages' share directories and from folders that the user named.

    Nothing that a client sends, or that arrives over the graph, changes which files these are. Paths are compared
    after links are resolved, so that a link can not lead out of these folders.

    Parameters
    ----------
    share_directory
        Finds a package's share directory; None when there is no such package.
    is_readable
        Returns whether a file outside of its package may be read, given its path without links: one that ``file://``
        names, or to which a link in a package leads.
    warn
        Called with a line about every URI that is refused.
    """

    def __init__(
        self,
        share_directory: Callable[[str], Path | None],
        is_readable: Callable[[Path], bool] = lambda path: False,
        warn: Callable[[str], object] = lambda line: None,
    ) -> None:
        self._share_directory = share_directory
        self._is_readable = is_readable
        self._warn = warn

    def read(self, uri: str, head: bytes = b"") -> bytearray:
        """Return the bytes of an asset, behind a head.

        Raises
        ------
        AssetError
            When the scheme is unknown, the file is absent, too large, or outside of what may be read.
        """
        try:
            return self._read(uri, head)
        except AssetRefusedError as error:
            self._warn(f"not served to the page: {error}")
            raise

    def _read(self, uri: str, head: bytes) -> bytearray:
        if len(uri) > MAX_URI_LENGTH:
            raise AssetError(f"{uri[:80]}...: longer than {MAX_URI_LENGTH} characters")
        try:
            path, share = self._locate(uri)
            path = texture_file(path)
            real = path.resolve()
            if not (share is not None and real.is_relative_to(share.resolve())) and not self._is_readable(real):
                raise AssetRefusedError(
                    f"{uri}: outside of the packages, the sources of their workspace, the model path "
                    "(GZ_SIM_RESOURCE_PATH) and the folders of files on the command line"
                )
            for name in (path, real):
                if name.suffix.lower() not in EXTENSIONS:
                    raise AssetError(f"{uri}: {name.suffix or 'a file without extension'} is not a mesh or texture")
            return _read_regular(real, uri, head)
        except FileNotFoundError:
            raise AssetError(f"{uri}: no such file") from None
        except (OSError, ValueError, RuntimeError) as error:  # a link to itself is a RuntimeError
            reason = error.strerror if isinstance(error, OSError) else str(error)
            raise AssetError(f"{uri}: {reason}") from None

    def _locate(self, uri: str) -> tuple[Path, Path | None]:
        """Return the path that a URI names, and its package's share directory for ``package://``."""
        try:
            parts = urlsplit(uri)
        except ValueError:
            raise AssetError(f"{uri}: not a URI") from None
        if parts.scheme == "package":
            return self._in_package(uri, parts.netloc, unquote(parts.path))
        if parts.scheme != "file":
            raise AssetError(f"{uri}: expected package:// or file://")
        if parts.netloc not in ("", "localhost"):
            raise AssetRefusedError(f"{uri}: names another machine")
        path = Path(url2pathname(parts.path))
        if not path.is_absolute():
            raise AssetError(f"{uri}: expected an absolute path")
        return path, None

    def _in_package(self, uri: str, package: str, path: str) -> tuple[Path, Path]:
        share = self._share_directory(package)
        if share is None:
            raise AssetError(f"{uri}: no package {package!r}")
        relative = PurePosixPath(path.lstrip("/"))
        if ".." in relative.parts or "\\" in path:
            raise AssetRefusedError(f"{uri}: leaves its package")
        return share.joinpath(*relative.parts), share


def _read_regular(path: Path, uri: str, head: bytes) -> bytearray:
    """Return a head and the bytes of a regular file; a pipe or a device would block or never end.

    Other threads run while the bytes are read to where they stay.
    """
    found = path.stat()
    if not stat.S_ISREG(found.st_mode):
        raise AssetError(f"{uri}: not a file")
    if found.st_size > LIMIT_BYTES:
        raise AssetError(f"{uri}: larger than {LIMIT_BYTES >> 20} MiB")
    data = bytearray(len(head) + found.st_size)
    data[: len(head)] = head
    end = len(head)
    with path.open("rb", buffering=0) as file, memoryview(data) as view:
        while read := file.readinto(view[end:]):
            end += read
    del data[end:]
    return data
