"""Context of the parts of the SDF reader."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from daidalos.description.markup import Element
from daidalos.description.resolve import PackageResolver, resolve_uri

BUILT_IN_MODELS = Path(__file__).parent / "models"


@dataclass(frozen=True)
class Context:
    """Resolution of names, and warnings so far.

    Parameters
    ----------
    version : tuple of 2 ints
        SDF version of the file being read.
    folder : Path
        Folder of the file being read.
    packages : callable or None
        Share directory of a package.
    model_path : sequence of Path
        Folders that hold models.
    strict : bool
        An include that cannot be found is an error; else it is left out, with a warning.
    warnings : list of str
        Shared by all files of one world.
    including : tuple of Path
        Files whose includes are being read, to find loops.
    """

    version: tuple[int, int]
    folder: Path
    packages: PackageResolver | None = None
    model_path: Sequence[Path] = ()
    strict: bool = True
    warnings: list[str] = field(default_factory=list)
    including: tuple[Path, ...] = ()

    def find(self, uri: str) -> Path | None:
        """Return the file or folder that `uri` means, or None."""
        return resolve_uri(uri, self.folder, self.packages, (*self.model_path, BUILT_IN_MODELS))

    def inside(self, file: Path, version: tuple[int, int]) -> Context:
        """Return the context for an included file."""
        return replace(self, folder=file.parent, version=version, including=(*self.including, file))

    def warn(self, element: Element, message: str) -> None:
        """Add a warning about an element."""
        self.warnings.append(f"{element.where}: {element.label}: {message}")
