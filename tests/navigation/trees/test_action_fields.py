"""Fields of the goals of action nodes."""

import pytest

from daidalos.navigation.trees.action.back_up import BackUp
from daidalos.navigation.trees.action.drive_on_heading import DriveOnHeading
from daidalos.navigation.trees.action.smooth_path import SmoothPath
from daidalos.navigation.trees.action.spin import Spin
from daidalos.navigation.trees.action.wait import Wait


@pytest.mark.parametrize(
    ("node", "inputs", "fields"),
    [
        (BackUp, {"backup_dist": 0.3, "backup_speed": 0.1}, {"target.x": 0.3, "speed": 0.1}),
        (DriveOnHeading, {"dist_to_travel": 0.3, "speed": 0.1}, {"target.x": 0.3, "speed": 0.1}),
        (Spin, {"spin_dist": 1.5, "time_allowance": 9.0}, {"target_yaw": 1.5, "time_allowance": 9.0}),
        (Wait, {"wait_duration": 2.0}, {"time": 2.0}),
        (SmoothPath, {"unsmoothed_path": "a path"}, {"path": "a path"}),
    ],
)
def test_inputs_set_the_fields_of_the_goal(node, inputs, fields):
    assert node.goal(inputs) == fields


def test_fields_of_the_result_set_the_outputs():
    class Result:
        path = "a smooth path"
        was_completed = True

    assert SmoothPath.outputs(Result()) == {"smoothed_path": "a smooth path", "was_completed": True}
