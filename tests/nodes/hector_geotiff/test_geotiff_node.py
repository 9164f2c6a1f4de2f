"""Pictures of maps that `geotiff_node` writes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hector_nav_msgs.srv import GetRobotTrajectory
from nav_msgs.msg import OccupancyGrid
from nav_msgs.msg import Path as PathMessage
from PIL import Image
from rcl_interfaces.msg import Log
from std_msgs.msg import String

from daidalos.mapping.geotiff import OBSTACLE_COLOR, WAY_COLOR
from daidalos.nodes.conversions import grid_message, pose_stamped
from daidalos.nodes.hector_geotiff.geotiff_node import GeotiffNode
from nodes.stepped import LATCHED, Stage


class Mapper:
    """A map, and what asks for pictures of it."""

    def __init__(self, set_stage: Callable[[dict[str, Any]], Stage], folder: Path) -> None:
        parameters = {"map_file_path": str(folder), "map_file_base_name": "arena"}
        self.stage = set_stage({"/hector_geotiff_node": parameters})
        self.log = self.stage.collect(Log, "/rosout", 100)
        self.stage.add(GeotiffNode())
        self.maps = self.stage.node.create_publisher(OccupancyGrid, "map", LATCHED)
        values = np.zeros((20, 40), np.int8)
        values[5, 10:30] = 100
        self.maps.publish(grid_message(values, 0.1, (-1.0, 2.0), "map", self.stage.stamp))
        self.stage.step()

    def save(self, text: str) -> None:
        """Ask for a picture, and wait until the log has a text."""
        self.stage.publish("syscommand", String(data="savegeotiff"))
        self.stage.step_until(lambda: any(text in one.msg for one in self.log))


def test_map_and_way_are_drawn_at_their_places(stage: Callable[[dict[str, Any]], Stage], tmp_path: Path) -> None:
    mapper = Mapper(stage, tmp_path)

    def serve(_: Any, response: Any) -> Any:
        poses = [pose_stamped((-0.5 + 0.1 * k, 3.05, 0.0), "map", mapper.stage.stamp) for k in range(30)]
        response.trajectory = PathMessage(poses=poses)
        return response

    mapper.stage.node.create_service(GetRobotTrajectory, "trajectory", serve)
    mapper.stage.step()
    mapper.save("with 30 poses of the way")
    (image,) = tmp_path.glob("arena_*.tif")
    width, _, _, height, left, top = map(float, image.with_suffix(".tfw").read_text().split())
    assert (width, height) == (0.1, -0.1)

    def at(x: float, y: float) -> tuple[int, ...]:
        return pixels.getpixel((round((x - left) / width), round((y - top) / height)))  # type: ignore[return-value]

    with Image.open(image) as pixels:
        assert pixels.size == (40, 20)
        assert at(0.55, 2.55) == OBSTACLE_COLOR
        assert at(0.55, 2.75) != OBSTACLE_COLOR
        assert at(1.45, 3.05) == WAY_COLOR


def test_a_picture_is_written_without_a_way(stage: Callable[[dict[str, Any]], Stage], tmp_path: Path) -> None:
    mapper = Mapper(stage, tmp_path)
    mapper.save("with 0 poses of the way")
    assert any("no service 'trajectory'" in one.msg for one in mapper.log)
    assert len(list(tmp_path.glob("arena_*.tif"))) == 1


def test_what_cannot_be_written_is_named(stage: Callable[[dict[str, Any]], Stage], tmp_path: Path) -> None:
    mapper = Mapper(stage, tmp_path / "absent")
    mapper.save("no picture is written")
    mapper.maps.publish(OccupancyGrid())
    mapper.stage.step()
    mapper.save("is not used")


@pytest.mark.parametrize("period", [-1.0])
def test_a_negative_period_is_refused(stage: Callable[[dict[str, Any]], Stage], period: float) -> None:
    stage({"/hector_geotiff_node": {"geotiff_save_period": period}})
    with pytest.raises(Exception, match="geotiff_save_period"):
        GeotiffNode()
