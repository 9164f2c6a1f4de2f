"""Docks that a robot knows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos.common.documents import DocumentError, read_yaml
from daidalos.common.errors import Location
from daidalos.common.parameters import ParameterError, Parameters, parameter, parameters_from
from daidalos.navigation.errors import DockNotValid


@dataclass(frozen=True)
class DockInstance(Parameters):
    """Dock, as parameter files and databases of Nav2 have it."""

    type: str = parameter("", "Name of the type among dock_plugins; may be empty where there is only one.")
    frame: str = parameter("map", "Frame of the pose.", not_empty=True)
    pose: tuple[float, ...] = parameter(
        (0.0, 0.0, 0.0), "Pose (x, y, yaw) of the docked robot.", unit="m, m, rad", length=3
    )
    id: str = parameter("", "Name of the dock for its type.")


def read_docks(path: Path | str) -> dict[str, DockInstance]:
    """Return the docks of a database: a YAML file with a mapping `docks`.

    Raises
    ------
    DockNotValid
        The file cannot be used; the message names the dock and what was expected.
    """
    place = Location(str(path))
    try:
        document = read_yaml(path)
    except DocumentError as error:
        raise DockNotValid(error.problem, error.location) from None
    except OSError as error:
        raise DockNotValid(f"cannot be read: {error.strerror or error}", place) from None
    docks = document.get("docks") if isinstance(document, Mapping) else None
    if not isinstance(docks, Mapping):
        raise DockNotValid("has no mapping 'docks'", place)
    return {str(name): _dock(str(name), values, place) for name, values in docks.items()}


def _dock(name: str, values: Any, place: Location) -> DockInstance:
    if not isinstance(values, Mapping):
        raise DockNotValid(f"the dock '{name}' is {values!r}, expected a mapping with 'type' and 'pose'", place)
    for key in ("type", "pose"):
        if key not in values:
            raise DockNotValid(f"the dock '{name}' has no '{key}'", place)
    try:
        return parameters_from(DockInstance, {str(key): value for key, value in values.items()})
    except ParameterError as error:
        raise DockNotValid(f"the dock '{name}': {error}", place) from None
