"""Parameters of `geotiff_node`."""

from __future__ import annotations

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter


@dataclass(frozen=True)
class GeotiffParameters(Parameters):
    """Parameters of the node, with ROS 1's names and defaults."""

    map_file_path: str = parameter(".", "Folder into which pictures are written.", not_empty=True)
    map_file_base_name: str = parameter("GeoTiffMap", "What the names of the files begin with.", not_empty=True)
    draw_background_checkerboard: bool = parameter(True, "Whether squares of 1 m are drawn where nothing is known.")
    draw_free_space_grid: bool = parameter(True, "Whether lines at each full meter are drawn where it is free.")
    geotiff_save_period: float = parameter(
        0.0, "How often a picture is written; only when asked for where 0.", unit="s", minimum=0.0, takes_integer=True,
        read_only=True,
    )  # fmt: skip
