"""The path that `hector_trajectory_server` publishes of transforms."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from hector_nav_msgs.srv import GetRecoveryInfo, GetRobotTrajectory
from nav_msgs.msg import Path
from rcl_interfaces.msg import Log
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from daidalos.nodes.conversions import transform_stamped
from daidalos.nodes.hector_trajectory_server.hector_trajectory_server import TrajectoryServer
from nodes.stepped import LATCHED, Stage

pytestmark = pytest.mark.timeout(300)


@pytest.mark.slow
def test_the_way_of_a_frame(stage: Callable[[dict[str, Any]], Stage]) -> None:
    parameters = {"trajectory_update_rate": 10, "trajectory_publish_rate": 1.0, "source_frame_name": "robot"}
    set_stage = stage({"/hector_trajectory_server": parameters})
    log = set_stage.collect(Log, "/rosout", 100)
    paths = set_stage.collect(Path, "trajectory", LATCHED)
    set_stage.add(TrajectoryServer())
    transforms = set_stage.node.create_publisher(TFMessage, "/tf", 100)
    set_stage.step_until(lambda: any("no pose is recorded" in one.msg for one in log))
    for k in range(10):
        transforms.publish(
            TFMessage(transforms=[transform_stamped((0.1 * k, 0.2, 0.3), "map", "robot", set_stage.stamp)])
        )
        set_stage.step(0.2)
    set_stage.step_until(lambda: bool(paths) and len(paths[-1].poses) == 10)
    assert paths[-1].header.frame_id == "map"
    assert [round(one.pose.position.x, 1) for one in paths[-1].poses] == [round(0.1 * k, 1) for k in range(10)]
    set_stage.step_for(1.0)
    assert len(paths[-1].poses) == 10  # the same transform is recorded once
    path = set_stage.call(GetRobotTrajectory, "/trajectory").trajectory
    assert path.poses == paths[-1].poses
    info = set_stage.call(
        GetRecoveryInfo, "/trajectory_recovery_info", request_time=path.poses[7].header.stamp, request_radius=0.35
    )
    assert info.req_pose == path.poses[7]
    assert info.radius_entry_pose == path.poses[3]
    assert info.trajectory_radius_entry_pose_to_req_pose.poses == path.poses[3:8]
    nothing = set_stage.call(GetRecoveryInfo, "/trajectory_recovery_info", request_radius=1.0)
    assert nothing.trajectory_radius_entry_pose_to_req_pose.poses == []
    set_stage.publish("syscommand", String(data="reset"))
    set_stage.step_until(lambda: any("the path was reset" in one.msg for one in log))
    set_stage.step_until(lambda: len(paths[-1].poses) == 1)
    set_stage.step(-50.0)
    transforms.publish(TFMessage(transforms=[transform_stamped((5.0, 0.2, 0.3), "map", "robot", set_stage.stamp)]))
    set_stage.step_until(lambda: any("time went back" in one.msg for one in log))
    set_stage.step_until(lambda: [one.pose.position.x for one in paths[-1].poses] == [5.0])
