"""Parameters of mapping without odometry."""

from dataclasses import dataclass

from daidalos.common.parameters import ParameterError, Parameters, parameter


@dataclass(frozen=True)
class HectorConfig(Parameters):
    """Size and place of the map, and when and how scans change it."""

    map_resolution: float = parameter(
        0.025, "Side of a cell of the finest grid.", unit="m", above=0.0, takes_integer=True, read_only=True
    )
    map_size: int = parameter(1024, "Cells of the finest grid along each side.", minimum=16, read_only=True)
    map_start_x: float = parameter(
        0.5, "Where the map's frame lies in the map: 0 left, 0.5 in the middle, 1 right.", minimum=0.0, maximum=1.0,
        takes_integer=True, read_only=True,
    )  # fmt: skip
    map_start_y: float = parameter(
        0.5, "Where the map's frame lies in the map: 0 at the bottom, 0.5 in the middle, 1 at the top.", minimum=0.0,
        maximum=1.0, takes_integer=True, read_only=True,
    )  # fmt: skip
    map_multi_res_levels: int = parameter(
        3, "Number of grids; each has cells of twice the size of the one before.", minimum=1, read_only=True
    )
    map_update_distance_thresh: float = parameter(
        0.4, "Motion after which a scan changes the map.", unit="m", minimum=0.0, takes_integer=True
    )
    map_update_angle_thresh: float = parameter(
        0.9, "Turn after which a scan changes the map.", unit="rad", minimum=0.0, takes_integer=True
    )
    update_factor_free: float = parameter(
        0.4, "Probability of an obstacle in a cell that a beam passed through.", above=0.0, maximum=0.5
    )
    update_factor_occupied: float = parameter(
        0.9, "Probability of an obstacle in a cell where a beam ended.", minimum=0.5, below=1.0
    )

    def check(self) -> None:
        """Refuse more levels than the map has cells for."""
        if self.map_size >> (self.map_multi_res_levels - 1) < 8:
            raise ParameterError(
                "map_multi_res_levels",
                f"leaves fewer than 8 cells of map_size {self.map_size} on the coarsest of "
                f"{self.map_multi_res_levels} levels",
            )
