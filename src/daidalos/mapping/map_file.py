"""Map files of map_server: a YAML file that defines the meaning of an image's grey values."""

import contextlib
import math
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from daidalos.common.documents import DocumentError, read_yaml
from daidalos.mapping.errors import MapFileError
from daidalos.mapping.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid
from daidalos.mapping.map_image import Format, Image, encode_image, read_image

Mode = Literal["trinary", "scale", "raw"]

OCCUPIED_THRESHOLD = 0.65
FREE_THRESHOLD = 0.196

FREE_GREY, UNKNOWN_GREY, OCCUPIED_GREY = 254, 205, 0
"""Grey values of a trinary image, as map_saver writes them."""


def load_map(path: str | Path) -> OccupancyGrid:
    """Read a map.

    In `trinary` mode a cell is occupied, free or unknown by the two thresholds; in `scale` mode what lies
    between them becomes 0 to 100, and what is transparent is unknown; in `raw` mode grey values 0 to 100 are
    taken as they are and others are unknown.

    Parameters
    ----------
    path : str or Path
        The YAML file; the image is looked for relative to it.

    Raises
    ------
    MapFileError
        Naming the file and the field or the part of the image.
    """
    yaml_path = Path(path)
    fields = _read_fields(yaml_path)
    image_path = yaml_path.parent / _text(yaml_path, fields, "image")
    mode = fields.get("mode", "trinary")
    if mode not in get_args(Mode):
        raise MapFileError(yaml_path, "mode", f"expected trinary, scale or raw, found {mode!r}")
    resolution = _number(yaml_path, fields, "resolution")
    if resolution <= 0.0:
        raise MapFileError(yaml_path, "resolution", f"expected metres per cell above 0, found {resolution:g}")
    negate = fields.get("negate", 0)
    if negate not in (0, 1):
        raise MapFileError(yaml_path, "negate", f"expected 0 or 1, found {negate!r}")
    occupied = _share(yaml_path, fields, "occupied_thresh")
    free = _share(yaml_path, fields, "free_thresh")
    if free >= occupied:
        raise MapFileError(
            yaml_path, "free_thresh", f"expected less than occupied_thresh ({occupied:g}), found {free:g}"
        )
    origin = _origin(yaml_path, fields)
    grey, opaque = read_image(image_path)
    data = _to_occupancy(grey, mode, bool(negate), occupied, free)
    if mode == "scale" and opaque is not None:
        data[~opaque] = UNKNOWN
    return OccupancyGrid(np.ascontiguousarray(np.flipud(data)), resolution, origin)


def save_map(
    grid: OccupancyGrid,
    stem: str | Path,
    mode: Mode = "trinary",
    *,
    image_format: Format = "pgm",
    occupied_thresh: float = OCCUPIED_THRESHOLD,
    free_thresh: float = FREE_THRESHOLD,
) -> tuple[Path, Path]:
    """Write `stem`.yaml and the image beside it; either both are replaced or neither.

    Parameters
    ----------
    grid : OccupancyGrid
        The map.
    stem : str or Path
        Path without extension; `.yaml` and those of images are taken off.
    mode : {"trinary", "scale", "raw"}
        What the grey values mean. `scale` needs a PNG image for unknown cells: they are transparent.
    image_format : {"pgm", "png", "bmp"}
        Format of the image, and its extension.
    occupied_thresh, free_thresh : float
        From which share of 1 on a cell is occupied, and up to which it is free.

    Returns
    -------
    tuple of Path
        The YAML file and the image.

    Raises
    ------
    MapFileError
        When the folder cannot be written to, the mode cannot hold the map or the thresholds make no sense.
    """
    import yaml

    base = Path(stem)
    if base.suffix in (".yaml", *(f".{name}" for name in get_args(Format))):
        base = base.with_suffix("")
    yaml_path, image_path = base.parent / f"{base.name}.yaml", base.parent / f"{base.name}.{image_format}"
    if not 0.0 <= free_thresh < occupied_thresh <= 1.0:
        raise MapFileError(
            yaml_path,
            "free_thresh",
            f"expected 0 <= free_thresh < occupied_thresh <= 1, found {free_thresh:g} and {occupied_thresh:g}",
        )
    if grid.data.size == 0:
        raise MapFileError(image_path, None, "the map has no cells")
    cells = np.flipud(grid.data)
    known = (cells >= FREE) & (cells <= OCCUPIED)
    if mode == "scale" and image_format != "png" and not known.all():
        raise MapFileError(
            image_path, "mode", f"scale cannot hold unknown cells in a {image_format.upper()} image; use PNG"
        )
    grey = _to_grey(cells, known, mode, occupied_thresh, free_thresh)
    image = encode_image(grey, known if mode == "scale" and image_format == "png" else None, image_format)
    description = yaml.safe_dump(
        {
            "image": image_path.name,
            "mode": mode,
            "resolution": float(grid.resolution),
            "origin": [float(value) for value in grid.origin],
            "negate": 0,
            "occupied_thresh": occupied_thresh,
            "free_thresh": free_thresh,
        },
        sort_keys=False,
        default_flow_style=None,
    )
    write_together({image_path: image, yaml_path: description.encode()})
    return yaml_path, image_path


def _to_occupancy(grey: Image, mode: str, negate: bool, occupied: float, free: float) -> NDArray[np.int8]:
    if mode == "raw":
        return np.where(grey <= OCCUPIED, grey.astype(np.int16), UNKNOWN).astype(np.int8)
    share = grey / 255.0 if negate else (255 - grey.astype(np.int16)) / 255.0
    middle = np.rint(100.0 * (share - free) / (occupied - free)) if mode == "scale" else np.full(grey.shape, UNKNOWN)
    return np.select([share > occupied, share < free], [OCCUPIED, FREE], middle).astype(np.int8)


def _to_grey(data: NDArray[np.int8], known: NDArray[np.bool_], mode: Mode, occupied: float, free: float) -> Image:
    if mode == "raw":
        return np.where(known, data, 255).astype(np.uint8)
    if mode == "trinary":
        chosen = [known & (data >= 100 * occupied), known & (data <= 100 * free)]
        return np.select(chosen, [OCCUPIED_GREY, FREE_GREY], _unknown_grey(occupied, free)).astype(np.uint8)
    share = free + (occupied - free) * data / 100.0
    share = np.select([data == FREE, data == OCCUPIED, ~known], [0.0, 1.0, 0.5], share)
    grey: Image = np.rint(255.0 * (1.0 - share)).astype(np.uint8)
    return grey


def _unknown_grey(occupied: float, free: float) -> int:
    """Return a grey value between the thresholds, which is read as unknown; the usual one if possible."""
    if free < 1.0 - UNKNOWN_GREY / 255.0 < occupied:
        return UNKNOWN_GREY
    return round(255.0 * (1.0 - (free + occupied) / 2.0))


def _read_fields(path: Path) -> dict[str, Any]:
    try:
        content = read_yaml(path)
    except OSError as error:
        raise MapFileError(path, None, error.strerror or str(error)) from error
    except DocumentError as error:
        raise MapFileError(path, None, f"not a YAML file: {error.described}") from error
    if not isinstance(content, dict):
        raise MapFileError(path, None, "expected a mapping with image, resolution, origin, ...")
    return content


def _field(path: Path, fields: dict[str, Any], name: str) -> Any:
    if fields.get(name) is None:
        raise MapFileError(path, name, "missing")
    return fields[name]


def _text(path: Path, fields: dict[str, Any], name: str) -> str:
    value = _field(path, fields, name)
    if not isinstance(value, str) or not value.isprintable():
        raise MapFileError(path, name, f"expected the name of a file, found {value!r}")
    return value


def _number(path: Path, fields: dict[str, Any], name: str) -> float:
    value = _field(path, fields, name)
    number = math.nan
    # PyYAML takes 1e-05 for text, where YAML 1.2 and map_server read a number.
    if isinstance(value, int | float | str) and not isinstance(value, bool):
        with contextlib.suppress(ValueError, OverflowError):
            number = float(value)
    if not math.isfinite(number):
        raise MapFileError(path, name, f"expected a number, found {value!r}")
    return number


def _share(path: Path, fields: dict[str, Any], name: str) -> float:
    value = _number(path, fields, name)
    if not 0.0 <= value <= 1.0:
        raise MapFileError(path, name, f"expected a number from 0 to 1, found {value:g}")
    return value


def _origin(path: Path, fields: dict[str, Any]) -> tuple[float, float, float]:
    value = _field(path, fields, "origin")
    if not isinstance(value, list) or len(value) != 3:
        raise MapFileError(path, "origin", f"expected [x, y, yaw], found {value!r}")
    named = {f"origin[{k}]": item for k, item in enumerate(value)}
    x, y, yaw = (_number(path, named, name) for name in named)
    return (x, y, yaw)


def write_together(contents: dict[Path, bytes]) -> None:
    """Write several files so that a failure keeps the old ones."""
    parts = {path: path.with_name(f".{path.name}.part") for path in contents}
    try:
        for path, part in parts.items():
            if path.is_dir():
                raise MapFileError(path, None, "is a folder")
            part.write_bytes(contents[path])
        for path, part in parts.items():
            part.replace(path)
    except OSError as error:
        raise MapFileError(next(iter(contents)), None, error.strerror or str(error)) from error
    except ValueError:  # a zero or a lone surrogate
        raise MapFileError(Path(ascii(str(next(iter(contents))))), None, "is a name that no file can have") from None
    finally:
        for part in parts.values():
            with contextlib.suppress(OSError, ValueError):  # where no file can have the name
                part.unlink(missing_ok=True)
