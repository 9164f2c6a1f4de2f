"""Map files of map_server: a YAML file that says what the grey values of a PGM image mean."""

import contextlib
import math
import re
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from daidalos.mapping.errors import MapFileError
from daidalos.mapping.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid

Mode = Literal["trinary", "scale", "raw"]
Image = NDArray[np.uint8]

OCCUPIED_THRESHOLD = 0.65
FREE_THRESHOLD = 0.196

FREE_GREY, UNKNOWN_GREY, OCCUPIED_GREY = 254, 205, 0
"""Grey values of a trinary image, as map_saver writes them."""


def load_map(path: str | Path) -> OccupancyGrid:
    """Read a map.

    In `trinary` mode a cell is occupied, free or unknown by the two thresholds; in `scale` mode what lies
    between them becomes 0 to 100; in `raw` mode grey values 0 to 100 are taken as they are and others are
    unknown.

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
    grey = np.flipud(_read_pgm(image_path))
    data = _to_occupancy(grey, mode, bool(negate), occupied, free)
    return OccupancyGrid(np.ascontiguousarray(data), resolution, origin)


def save_map(grid: OccupancyGrid, stem: str | Path, mode: Mode = "trinary") -> tuple[Path, Path]:
    """Write `stem`.pgm and `stem`.yaml; either both are replaced or neither.

    Parameters
    ----------
    grid : OccupancyGrid
        The map.
    stem : str or Path
        Path without extension; `.yaml` and `.pgm` are taken off.
    mode : {"trinary", "scale", "raw"}
        What the grey values mean. `scale` holds no unknown cells, since a PGM image has no transparency.

    Returns
    -------
    tuple of Path
        The YAML file and the image.

    Raises
    ------
    MapFileError
        When the folder can not be written to, or the mode can not hold the map.
    """
    import yaml

    base = Path(stem)
    if base.suffix in (".yaml", ".pgm"):
        base = base.with_suffix("")
    yaml_path, image_path = base.parent / f"{base.name}.yaml", base.parent / f"{base.name}.pgm"
    if grid.data.size == 0:
        raise MapFileError(image_path, None, "the map has no cells")
    grey = np.flipud(_to_grey(grid.data, mode, image_path))
    header = f"P5\n{grey.shape[1]} {grey.shape[0]}\n255\n".encode()
    description = yaml.safe_dump(
        {
            "image": image_path.name,
            "mode": mode,
            "resolution": float(grid.resolution),
            "origin": [float(value) for value in grid.origin],
            "negate": 0,
            "occupied_thresh": OCCUPIED_THRESHOLD,
            "free_thresh": FREE_THRESHOLD,
        },
        sort_keys=False,
        default_flow_style=None,
    )
    _write_together({image_path: header + grey.tobytes(), yaml_path: description.encode()})
    return yaml_path, image_path


def _to_occupancy(grey: Image, mode: str, negate: bool, occupied: float, free: float) -> NDArray[np.int8]:
    if mode == "raw":
        return np.where(grey <= OCCUPIED, grey.astype(np.int16), UNKNOWN).astype(np.int8)
    share = grey / 255.0 if negate else (255 - grey.astype(np.int16)) / 255.0
    middle = np.rint(100.0 * (share - free) / (occupied - free)) if mode == "scale" else np.full(grey.shape, UNKNOWN)
    return np.select([share > occupied, share < free], [OCCUPIED, FREE], middle).astype(np.int8)


def _to_grey(data: NDArray[np.int8], mode: Mode, path: Path) -> Image:
    known = (data >= FREE) & (data <= OCCUPIED)
    if mode == "raw":
        return np.where(known, data, 255).astype(np.uint8)
    if mode == "trinary":
        occupied = known & (data >= 100 * OCCUPIED_THRESHOLD)
        free = known & (data <= 100 * FREE_THRESHOLD)
        return np.select([occupied, free], [OCCUPIED_GREY, FREE_GREY], UNKNOWN_GREY).astype(np.uint8)
    if not known.all():
        raise MapFileError(path, "mode", "scale can not hold unknown cells in a PGM image; use trinary or raw")
    share = FREE_THRESHOLD + (OCCUPIED_THRESHOLD - FREE_THRESHOLD) * data / 100.0
    share = np.select([data == FREE, data == OCCUPIED], [0.0, 1.0], share)
    grey: Image = np.rint(255.0 * (1.0 - share)).astype(np.uint8)
    return grey


def _read_fields(path: Path) -> dict[str, Any]:
    import yaml

    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise MapFileError(path, None, error.strerror or str(error)) from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise MapFileError(path, None, "not a YAML file: " + " ".join(str(error).split())) from error
    if not isinstance(content, dict):
        raise MapFileError(path, None, "expected a mapping with image, resolution, origin, ...")
    return content


def _field(path: Path, fields: dict[str, Any], name: str) -> Any:
    if fields.get(name) is None:
        raise MapFileError(path, name, "missing")
    return fields[name]


def _text(path: Path, fields: dict[str, Any], name: str) -> str:
    value = _field(path, fields, name)
    if not isinstance(value, str):
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


def _read_pgm(path: Path) -> Image:
    """Grey values 0 to 255, shape (rows, columns), the top row first."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise MapFileError(path, None, error.strerror or str(error)) from error
    gap = rb"(?:\s|#[^\n]*\n)+"
    header = re.match(rb"(P[25])" + (gap + rb"(\d{1,9})") * 3 + rb"\s", content)
    if header is None:
        raise MapFileError(path, "header", "expected a PGM image (P5 or P2); other formats are not read")
    columns, rows, brightest = (int(header.group(k)) for k in (2, 3, 4))
    if not 1 <= brightest <= 255:
        raise MapFileError(path, "header", f"expected a largest grey value from 1 to 255, found {brightest}")
    if rows == 0 or columns == 0:
        raise MapFileError(path, "header", f"expected at least one pixel, found {columns} x {rows}")
    body = content[header.end() :]
    values = _read_text_pixels(path, body) if header.group(1) == b"P2" else np.frombuffer(body, np.uint8)
    if values.size < rows * columns:
        raise MapFileError(path, "pixels", f"expected {columns} x {rows} = {rows * columns}, found {values.size}")
    grey = values[: rows * columns].reshape(rows, columns)
    if brightest == 255:
        return grey
    return np.rint(np.minimum(grey, brightest) * (255.0 / brightest)).astype(np.uint8)


def _read_text_pixels(path: Path, body: bytes) -> Image:
    try:
        values = [int(word) for word in re.sub(rb"#[^\n]*", b"", body).split()]
        return np.array(values, dtype=np.uint8)
    except (ValueError, OverflowError) as error:
        raise MapFileError(path, "pixels", f"expected numbers from 0 to 255: {error}") from error


def _write_together(contents: dict[Path, bytes]) -> None:
    """Write several files so that a failure leaves the old ones."""
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
    finally:
        for part in parts.values():
            part.unlink(missing_ok=True)
