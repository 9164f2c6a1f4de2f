"""Reader of SDF files; passes their root to the reader of worlds or of models."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from daidalos.description.errors import DescriptionError
from daidalos.description.markup import Element, parse_markup
from daidalos.description.resolve import PackageResolver, default_model_path
from daidalos.description.sdf.context import Context
from daidalos.description.sdf.includes import check_version, model_file, read_version
from daidalos.description.sdf.models import read_model
from daidalos.description.sdf.worlds import read_world
from daidalos.description.world import Model, World


def load(
    path: Path | str,
    resolve: PackageResolver | None = None,
    model_path: Sequence[Path] | None = None,
    strict: bool = False,
) -> World:
    """Read a world from a file.

    Parameters
    ----------
    path : Path or str
        An ``.sdf`` or ``.world`` file. One that holds only a model gives a world with that model.
    resolve : callable or None
        Share directory of a package, for ``package://``.
    model_path : sequence of Path or None
        Folders that hold models, for ``model://``; None takes those of Gazebo's environment variables.
    strict : bool
        An included model that is not found is an error. Else it is left out with a warning, as in Gazebo, and
        so are the joints to it.

    Returns
    -------
    World

    Raises
    ------
    DescriptionError
        When a file is missing or wrong; names file, line and element.
    """
    path = Path(path)
    return parse(_read(path), str(path), resolve, model_path, strict)


def parse(
    text: str | bytes,
    source: str = "world",
    resolve: PackageResolver | None = None,
    model_path: Sequence[Path] | None = None,
    strict: bool = False,
) -> World:
    """Read a world from text; relative paths start at the folder of `source`. See `load`."""
    root, context = _open(text, source, resolve, model_path, strict)
    element = root.first("world")
    for other in root.all("world")[1:]:
        context.warn(other, "only the first world counts, left out")
    if element is not None:
        return read_world(element, context)
    if root.first("model", "include", "light", "actor") is None:
        raise root.error("expected <world>, <model>, <light> or <actor>")
    return read_world(Element("world", {"name": "default"}, children=root.children, source=source), context)


def load_model(
    path: Path | str,
    resolve: PackageResolver | None = None,
    model_path: Sequence[Path] | None = None,
) -> Model:
    """Read a model from a file, or from a folder with a ``model.config``. See `load`."""
    path = model_file(Path(path), Element("include", source=str(path)))
    return parse_model(_read(path), str(path), resolve, model_path)


def parse_model(
    text: str | bytes,
    source: str = "model",
    resolve: PackageResolver | None = None,
    model_path: Sequence[Path] | None = None,
    strict: bool = True,
) -> Model:
    """Read a model from text; relative paths start at the folder of `source`. See `load`."""
    root, context = _open(text, source, resolve, model_path, strict)
    element = root.first("model")
    if element is None:
        raise root.error("expected <model>")
    return replace(read_model(element, context), warnings=tuple(context.warnings))


def parse_any(
    text: str | bytes,
    source: str = "description",
    resolve: PackageResolver | None = None,
    model_path: Sequence[Path] | None = None,
    strict: bool = True,
) -> Model | World:
    """Read a model from a document with a single model, else a world. See `load`."""
    tags = [child.tag for child in parse_markup(text, source).children]
    if tags == ["model"]:
        return parse_model(text, source, resolve, model_path, strict)
    return parse(text, source, resolve, model_path, strict)


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise DescriptionError("no such file", str(path)) from None
    except OSError as problem:
        raise DescriptionError(problem.strerror or str(problem), str(path)) from None


def _open(
    text: str | bytes,
    source: str,
    resolve: PackageResolver | None,
    model_path: Sequence[Path] | None,
    strict: bool = True,
) -> tuple[Element, Context]:
    root = parse_markup(text, source)
    if root.tag not in ("sdf", "gazebo"):
        raise root.error("expected <sdf> as the root element")
    context = Context(
        version=read_version(root),
        folder=Path(source).parent,
        packages=resolve,
        model_path=default_model_path() if model_path is None else tuple(model_path),
        strict=strict,
        including=(Path(source),),
    )
    check_version(root, context)
    return root, context
