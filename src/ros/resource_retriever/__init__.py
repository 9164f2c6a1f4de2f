"""Files that are named by an address: ``package://``, ``file://`` or one of the network."""

from __future__ import annotations

PACKAGE_PREFIX = "package://"


def get_filename(url: str, use_protocol: bool = True) -> str:
    """Return where a file is that is named by its package; any other address as it is.

    Parameters
    ----------
    url
        Such as ``package://my_robot/meshes/arm.dae``.
    use_protocol
        Whether ``file://`` stands before the path.

    Raises
    ------
    ValueError
        If the address names no file in the package.
    ament_index_python.packages.PackageNotFoundError
        If there is no such package.
    """
    if not url.startswith(PACKAGE_PREFIX):
        return url
    from ament_index_python.packages import get_package_share_directory

    package, slash, path = url.removeprefix(PACKAGE_PREFIX).partition("/")
    if not (package and slash and path):
        raise ValueError(f"'{url}' names no file in a package; such a name looks like package://name/folder/file")
    return f"{'file://' if use_protocol else ''}{get_package_share_directory(package)}/{path}"


def get(url: str) -> bytes:
    """Return what is in a file that is named by an address.

    Raises
    ------
    OSError
        If it cannot be read.
    ValueError, ament_index_python.packages.PackageNotFoundError
        See `get_filename`.
    """
    if url.startswith(PACKAGE_PREFIX):
        with open(get_filename(url, use_protocol=False), "rb") as file:
            return file.read()
    from urllib.request import urlopen

    with urlopen(url) as answer:
        content: bytes = answer.read()
        return content
