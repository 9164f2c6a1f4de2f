"""Filters of a costmap, with the test as the servers of masks and of what these mean."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from nav2_msgs.msg import Costmap, CostmapFilterInfo, SpeedLimit
from std_msgs.msg import Bool
from std_srvs.srv import SetBool

from daidalos.nodes.conversions import grid_message
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_of
from daidalos.nodes.nav2_planner.planner_server import PlannerServer
from daidalos.samples.fields import time_message
from nodes.stepped import LATCHED, Stage

pytestmark = [pytest.mark.usefixtures("compiled"), pytest.mark.timeout(300)]

NODE = "/global_costmap/global_costmap"
PARAMETERS: dict[str, Any] = {
    "width": 4,
    "height": 3,
    "resolution": 1.0,
    "update_frequency": 20.0,
    "publish_frequency": 20.0,
    "plugins": [],
    "filters": ["keepout_filter"],
    "keepout_filter": {"plugin": "nav2_costmap_2d::KeepoutFilter", "filter_info_topic": "zone_info"},
}


class Bench:
    """A planner server whose costmap has filters."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.robot = stage.add_robot()
        self.server = stage.add(PlannerServer())
        self.costmaps = stage.collect(Costmap, "/global_costmap/costmap_raw", LATCHED)
        self.server.trigger_configure()
        self.server.trigger_activate()

    def explain(self, mask: str, kind: int = 0, **values: float) -> None:
        self.stage.publish("/zone_info", CostmapFilterInfo(type=kind, filter_mask_topic=mask, **values), LATCHED)

    def show(self, topic: str, values: list[int], frame: str = "map") -> None:
        mask = grid_message(np.array([values], np.int8), 1.0, (0.0, 0.0), frame, time_message(0))
        self.stage.publish(topic, mask, LATCHED)

    def step_until_row(self, costs: list[int]) -> None:
        self.stage.step_until(lambda: bool(self.costmaps) and costmap_of(self.costmaps[-1]).costs[0].tolist() == costs)


def test_masks_and_what_they_mean_may_change(
    stage: Callable[[dict[str, Any]], Stage], capfd: pytest.CaptureFixture[str]
) -> None:
    bench = Bench(stage({NODE: PARAMETERS}))
    bench.show("/first", [0, 100])
    bench.explain("first", multiplier=1.0)
    bench.step_until_row([0, 254, 0, 0])
    bench.show("/first", [0, 0, 50])
    bench.step_until_row([0, 0, 127, 0])
    bench.show("/second", [100], frame="odom")
    bench.explain("/second", multiplier=1.0)
    bench.step_until_row([254, 0, 0, 0])
    assert bench.stage.node.count_subscribers("/first") == 0
    broken = grid_message(np.zeros((1, 1), np.int8), 1.0, (0.0, 0.0), "map", time_message(0))
    broken.info.width = 7
    bench.stage.publish("/second", broken, LATCHED)
    printed: list[str] = []

    def is_refused() -> bool:
        printed.append(capfd.readouterr().err)
        return "7 x 1" in "".join(printed)

    bench.stage.step_until(is_refused)
    bench.show("/second", [0, 100], frame="odom")
    bench.step_until_row([0, 254, 0, 0])


def test_a_service_switches_a_filter(stage: Callable[[dict[str, Any]], Stage]) -> None:
    bench = Bench(stage({NODE: PARAMETERS}))
    bench.show("/first", [100])
    bench.explain("first", multiplier=1.0)
    bench.step_until_row([254, 0, 0, 0])
    for enabled, message, cost in ((False, "Disabled", 0), (True, "Enabled", 254)):
        answer = bench.stage.call(SetBool, "/global_costmap/keepout_filter/toggle_filter", data=enabled)
        assert (answer.success, answer.message) == (True, message)
        bench.step_until_row([cost, 0, 0, 0])
        assert bench.server._costmap.get_parameter("keepout_filter.enabled").value is enabled


def test_speed_limits_and_states_are_published_where_the_robot_is(stage: Callable[[dict[str, Any]], Stage]) -> None:
    names = {"speed_filter": "SpeedFilter", "binary_filter": "BinaryFilter"}
    filters = {
        name: {"plugin": f"nav2_costmap_2d::{kind}", "filter_info_topic": f"/{name}_info"}
        for name, kind in names.items()
    }
    test = stage({NODE: {**PARAMETERS, **filters, "filters": list(names)}})
    limits, states = test.collect(SpeedLimit, "/speed_limit"), test.collect(Bool, "/binary_state")
    bench = Bench(test)
    bench.robot.pose = np.array([0.5, 0.5, 0.0])
    bench.show("/zones", [0, 60])
    for name, kind in (("speed_filter", 1), ("binary_filter", 3)):
        info = CostmapFilterInfo(type=kind, filter_mask_topic="zones", multiplier=1.0)
        test.publish(f"/{name}_info", info, LATCHED)
    test.step_until(lambda: bool(states))
    for x, limit, state in ((1.5, 60.0, True), (0.5, 0.0, False)):
        bench.robot.pose = np.array([x, 0.5, 0.0])
        test.step_until(lambda limit=limit: bool(limits) and limits[-1].speed_limit == limit)
        test.step_until(lambda state=state: states[-1].data == state)
    assert [(one.percentage, one.speed_limit, one.header.frame_id) for one in limits] == [
        (True, 60.0, "map"),
        (True, 0.0, "map"),
    ]
    assert [one.data for one in states] == [False, True, False]
