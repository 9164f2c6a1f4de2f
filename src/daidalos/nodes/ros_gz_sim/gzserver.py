"""`gzserver`: the simulator as a component, whose world is a parameter."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos.common.parameters import Parameters, parameter
from daidalos.common.temporary_files import write_temporary
from daidalos.nodes.asset_folders import record_model_path, record_named_files
from daidalos.nodes.gazebo_ros import gzserver
from daidalos.nodes.gazebo_ros._worlds import find_world
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import UserError, run


@dataclass(frozen=True)
class WorldParameters(Parameters):
    """Parameters that name the world."""

    world_sdf_file: str = parameter("", "SDF file of the world; an empty world with a ground by default.")
    world_sdf_string: str = parameter("", "The world itself as SDF, where no file is given.")


class GzServer(gzserver.GzServer):
    """Simulator that runs at once.

    Raises
    ------
    UserError
        When there is no such file.
    DescriptionError, SimulationError
        When the world cannot be used.
    """

    def __init__(self, **kwargs: Any) -> None:
        record_model_path()
        super().__init__(self._read_start, **kwargs)

    def _read_start(self) -> gzserver.Start:
        settings = declare(self, WorldParameters)
        try:
            return gzserver.Start(_world_file(settings))
        except FileNotFoundError as error:
            raise UserError(f"parameter 'world_sdf_file': {error}") from None


def _world_file(settings: WorldParameters) -> Path | None:
    if settings.world_sdf_file or not settings.world_sdf_string:
        record_named_files([settings.world_sdf_file])
        return find_world(settings.world_sdf_file)
    return write_temporary(settings.world_sdf_string, "world_", ".sdf")


def main() -> int:
    """Run the node."""
    return run(GzServer, threads=GzServer.THREADS)
